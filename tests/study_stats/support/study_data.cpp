#include "tests/study_stats/support/study_data.h"

#include <fstream>
#include <sstream>

namespace study::test {

std::filesystem::path study_data()
{
    return std::filesystem::path(LIGHTWELL_SOURCE_DIR) / ".." / "shared" / "data" / "study";
}

nlohmann::json read_json(std::string const& name)
{
    std::ifstream in(study_data() / name);
    return nlohmann::json::parse(in);
}

std::vector<std::vector<std::string>> read_csv(std::string const& name)
{
    std::ifstream in(study_data() / name);
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(in, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        std::istringstream cells(line);
        rows.emplace_back();
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
}

Matrix read_table(std::string const& name)
{
    auto const rows = read_csv(name);
    Matrix table(rows.size() - 1, rows.at(0).size() - 1);
    for (std::size_t r = 0; r < table.rows; ++r)
        for (std::size_t c = 0; c < table.columns; ++c) table(r, c) = std::stod(rows[r + 1].at(c + 1));
    return table;
}

void expect_near(std::vector<double> const& values, std::vector<double> const& expected, double tolerance,
                 std::string const& what)
{
    ASSERT_EQ(values.size(), expected.size()) << what;
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(values[i], expected[i], tolerance) << what << " " << i;
}

} // namespace study::test
