#pragma once
// Real scenes and hard inputs for tests: data outside the repository, in a folder beside
// it. Tests skip where it is missing.

#include <filesystem>
#include <gtest/gtest.h>

namespace gi::test {

/// ../shared/data of the checkout; empty where it is absent.
std::filesystem::path shared_data();

} // namespace gi::test

/// Skips the test, visibly, where the file or folder is not there.
/// @param path absolute, or relative to shared_data()
#define LIGHTWELL_NEED_DATA(path)                                                                                 \
    do {                                                                                                          \
        if (gi::test::shared_data().empty() || !std::filesystem::exists(gi::test::shared_data() / (path)))        \
            GTEST_SKIP() << "SKIPPED: no test data at " << (path);                                                \
    } while (false)
