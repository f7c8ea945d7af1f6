// Measuring through the program, and the check of the chain itself.

#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

using Json = nlohmann::json;

double value_of(Json const& table, std::string const& column, std::size_t row = 0)
{
    auto const& columns = table.at("columns");
    auto const at = std::find(columns.begin(), columns.end(), column) - columns.begin();
    Json const& cell = table.at("rows").at(row).at(std::size_t(at));
    return cell.is_object() ? cell.at("median").get<double>() : cell.is_null() ? -1 : cell.get<double>();
}

TEST(ArBench, TellsSpeedWithItsError)
{
    TemporaryFolder const folder;
    std::string const call =
        "ar bench --size 640x480 --frames 2 --paths 1 --truth-paths 2 --folder desks --out table";
    EXPECT_NE(run_well("ar bench --help", folder.path()).out.find("  lightwell " + call + "\n"), std::string::npos)
        << "the example, which is run here";
    Outcome const o = run_well(call + " --still-frames 3", folder.path());
    EXPECT_NE(o.out.find("render"), std::string::npos) << o.out;
    Json const table = Json::parse(file_text(folder / "table/ar.json"));
    ASSERT_EQ(table.at("rows").size(), 2u);
    EXPECT_EQ(value_of(table, "paths", 0), 0) << "prefiltered light";
    EXPECT_EQ(value_of(table, "flicker_percent", 0), 0);
    EXPECT_GT(value_of(table, "flicker_percent", 1), 1) << "of one path";
    EXPECT_LT(value_of(table, "flip_affected", 0), value_of(table, "flip_affected", 1));
    for (std::size_t row : {0u, 1u}) {
        EXPECT_GT(value_of(table, "fast_frames_per_s", row), 0);
        EXPECT_GT(value_of(table, "flip_affected", row), 0);
        EXPECT_GT(value_of(table, "flip_of_adding_nothing", row), value_of(table, "flip_elsewhere", row));
        EXPECT_EQ(value_of(table, "found_percent", row), 100);
        EXPECT_LT(value_of(table, "flip_affected", row), value_of(table, "flip_of_adding_nothing", row));
        EXPECT_GT(value_of(table, "plain_opencv_over_composite", row), 0);
        EXPECT_LT(value_of(table, "plain_opencv_differs_bytes", row), 1);
        EXPECT_LT(value_of(table, "position_mm", row), 10);
        EXPECT_GT(value_of(table, "search_share_of_detect", row), 0);
    }
    Json const stages = Json::parse(file_text(folder / "table/ar_stages.json"));
    EXPECT_GT(stages.at("rows").size(), 10u);
    Json const curve = Json::parse(file_text(folder / "table/ar_confidence.json"));
    ASSERT_GT(curve.at("rows").size(), 0u); // by rising confidence
    EXPECT_LT(value_of(curve, "position_median_mm", curve.at("rows").size() - 1), 10);
    EXPECT_TRUE(std::filesystem::exists(folder / "desks"));
}

TEST(ArBench, FindsNumberBallAndTimesInAgreement)
{
    TemporaryFolder const folder;
    Outcome const o = run("ar bench --counter --size 320x240 --frames 12 --json", folder.path());
    EXPECT_EQ(o.code, 0) << o.err << o.out;
    Json const table = Json::parse(o.out).at("ar_counter");
    EXPECT_EQ(value_of(table, "frames"), 12);
    EXPECT_EQ(value_of(table, "ball_elsewhere"), 0);
    EXPECT_LT(value_of(table, "ball_off_most_px"), 1.5);
}

} // namespace
} // namespace viewer::test
