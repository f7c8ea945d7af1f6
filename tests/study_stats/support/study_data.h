#pragma once
// The reference data of study statistics lie beside the checkout, where they are present.

#include "study/numeric/matrix.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>

namespace study::test {

/// ../shared/data/study of the checkout; it may be absent.
std::filesystem::path study_data();
nlohmann::json read_json(std::string const& name);
/// Rows of cells, the header first.
std::vector<std::vector<std::string>> read_csv(std::string const& name);
/// The table of a file whose first row and column are names.
Matrix read_table(std::string const& name);
/// Each |value - expected| within `tolerance`.
void expect_near(std::vector<double> const& values, std::vector<double> const& expected, double tolerance,
                 std::string const& what);

} // namespace study::test

/// Skips the test, visibly, where the data are absent.
#define LIGHTWELL_NEED_STUDY_DATA()                                                                               \
    do {                                                                                                          \
        if (!std::filesystem::is_directory(study::test::study_data()))                                            \
            GTEST_SKIP() << "SKIPPED: no reference data at " << study::test::study_data();                        \
    } while (false)
