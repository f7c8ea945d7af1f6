#include "ar/markers/marker_map_file.h"

#include "ar/markers/map_doubts.h"
#include "ar/markers/seen_ids.h"
#include "gi/core/error.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

std::string message_of(std::string const& text)
{
    try {
        parse_marker_map(text, "m.yaml");
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "no error";
}

TEST(MarkerMapFile, ComesBackAsItWas)
{
    MarkerMap map;
    gi::RigidPose const flat{{0.1, 0, -0.3}, glm::angleAxis(-glm::radians(90.), glm::dvec3(1, 0, 0))};
    map.markers = {{"DICT_4X4_50", 3, 0.08, {}}, {"DICT_APRILTAG_36h11", 3, 0.1 / 3, flat}};
    map.boards = {{8, 5, 0.03, 0.022, "DICT_5X5_100", 7, true, flat}};
    map.grids = {{2, 3, 0.05, 0.01, "DICT_6X6_250", 100, {}}};
    check(map, "map");
    EXPECT_EQ(parse_marker_map(format_marker_map(map), "m.yaml"), map);
}

TEST(MarkerMapFile, TurnsAboutXThenYThenZ)
{
    MarkerMap const map = parse_marker_map(
        "markers:\n  - {dictionary: DICT_4X4_50, id: 0, side_m: 0.1, rotation_deg: [-90, 90, 0]}\n", "m.yaml");
    // Out of the paper: up after the first turn; the printed top: away, then to -x.
    glm::dvec3 const out = map.markers[0].world_from_marker * glm::dvec3(0, 0, 1);
    glm::dvec3 const top = map.markers[0].world_from_marker * glm::dvec3(0, 1, 0);
    EXPECT_LT(glm::distance(out, glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_LT(glm::distance(top, glm::dvec3(-1, 0, 0)), 1e-12);
}

TEST(MarkerMapFile, SaysWhatIsWrongAndWhere)
{
    std::string const marker = "markers:\n  - {dictionary: DICT_4X4_50, id: 1, side_m: 0.1}\n";
    EXPECT_NE(message_of(marker + "  - {dictionary: DICT_4X4_50, id: 1, side_m: 0.1}\n")
                  .find("m.yaml:3:5: marker 1 of DICT_4X4_50 is there twice"),
              std::string::npos)
        << message_of(marker + "  - {dictionary: DICT_4X4_50, id: 1, side_m: 0.1}\n");
    struct Case {
        char const *text, *message;
    };
    for (Case const& c : {
             Case{"markers:\n  - {dictionary: DICT_4X4_5, id: 1, side_m: 0.1}\n",
                  "m.yaml:2:18: 'DICT_4X4_5' is no dict"},
             Case{"markers:\n  - {dictionary: DICT_4X4_50, id: 50, side_m: 0.1}\n", "m.yaml:2:5: marker 50 of"},
             Case{"markers:\n  - {dictionary: DICT_4X4_50, id: 1, side_m: -0.1}\n",
                  "m.yaml:2:46: markers[0].side_m is"},
             Case{"markers:\n  - {dictionary: DICT_4X4_50, id: 1, side_m: .nan}\n", "is not a number"},
             Case{"markers:\n  - {dictionary: DICT_4X4_50, id: 1, side: 0.1}\n",
                  "m.yaml:2:38: unknown key 'side'"},
             Case{"markers:\n  - {id: 1, side_m: 0.1}\n", "has no 'dictionary'"},
             Case{"boards:\n  - {squares_x: 5, squares_y: 4, square_m: 0.02, marker_m: 0.03, dictionary: "
                  "DICT_4X4_50}\n",
                  "markers need white around them"},
             Case{"boards:\n  - {squares_x: 50, squares_y: 4, square_m: 0.02, marker_m: 0.01, dictionary: "
                  "DICT_4X4_50}\n",
                  "DICT_4X4_50 has 0 to 49"},
             Case{"markers:\n  - {dictionary: DICT_4X4_50, id: 1, side_m: 1, rotation_xyzw: [1, 1, 0, 0]}\n",
                  "the quaternion's length is"},
             Case{"markers: []\n", "there is no marker"},
             Case{"", "is not a map"},
             Case{"markers: [", "this is not YAML"},
         })
        EXPECT_NE(message_of(c.text).find(c.message), std::string::npos) << message_of(c.text);
}

TEST(MarkerMap, NumbersThingsAndPlacesMarkers)
{
    MarkerMap map;
    map.markers = {{"DICT_4X4_50", 3, 0.08, {}}};
    map.boards = {{3, 4, 1, 0.5, "DICT_4X4_50", 10, false, {}}};
    map.grids = {{2, 2, 2, 1, "DICT_4X4_50", 20, {}}};
    auto const all = placed_markers(map);
    ASSERT_EQ(all.size(), 1u + 6u + 4u);
    EXPECT_EQ(all[0].corners_m[0], glm::dvec3(-0.04, 0.04, 0));
    EXPECT_EQ(all[1].id, 10);
    EXPECT_EQ(all[1].thing, 1);
    EXPECT_EQ(all[1].corners_m[0], glm::dvec3(1.25, 3.75, 0));
    EXPECT_EQ(all[7].thing, 2);
    EXPECT_EQ(all[7].corners_m[0], glm::dvec3(0, 5, 0));
    EXPECT_EQ(all[10].corners_m[2], glm::dvec3(5, 0, 0));
    EXPECT_EQ(inner_corners(map.boards[0]).front(), glm::dvec3(1, 3, 0));
    EXPECT_EQ(marker_count(map.boards[0]), 6);
}

TEST(MarkerMapDoubts, AreAboutSizesThatAreHardlyInMetres)
{
    auto const marker = [](double side_m, glm::dvec3 at = {}) {
        return MarkerMap{{{"DICT_4X4_50", 1, side_m, {at, {1, 0, 0, 0}}}}, {}, {}};
    };
    auto const board = [](double square_m, double marker_m, glm::dvec3 at = {}) {
        return MarkerMap{{}, {{7, 5, square_m, marker_m, "DICT_4X4_50", 0, false, {at, {1, 0, 0, 0}}}}, {}};
    };
    auto const grid = [](double marker_m, double gap_m) {
        return MarkerMap{{}, {}, {{2, 3, marker_m, gap_m, "DICT_4X4_50", 0, {}}}};
    };
    struct Case {
        MarkerMap map;
        std::string words; ///< empty: no doubt
    };
    std::vector<Case> const cases{
        {marker(0.08), ""},
        {marker(2.5), ""},
        {marker(80), "write 0.08"},
        {marker(3.5), "metres?"},
        {marker(0.00008), "these are 0.08 mm"},
        {marker(0.006), ""},
        {marker(0.08, {0, 0, 320}), "320 m from the origin"},
        {board(0.045, 0.034), ""},
        {board(45, 34),
         "board 1 (7 x 5 squares) is 315 m wide: are its lengths in metres? if it is 315 mm, write 0.315"},
        {board(4.5, 3.4), "31.5 m wide"},
        {board(0.000045, 0.000034), "these are 0.315 mm"},
        {board(0.045, 0.034, {-157.5, 0, 320}), "from the origin"},
        {grid(0.05, 0.01), ""},
        {grid(50, 10), "grid 1 (2 x 3 markers) is 170 m wide"},
    };
    for (Case const& c : cases) {
        std::vector<std::string> const doubts = doubts_about(c.map);
        EXPECT_EQ(doubts.size(), c.words.empty() ? 0u : 1u) << c.words;
        if (!doubts.empty()) {
            EXPECT_NE(doubts[0].find(c.words), std::string::npos) << doubts[0];
        }
        gi::Report report;
        report_doubts(c.map, "m.yaml", report);
        EXPECT_EQ(report.losses().size(), doubts.size());
    }
}

TEST(SeenIds, AreComparedWithTheMaps)
{
    EXPECT_EQ(ranges_of({0, 1, 2, 5, 7, 8}), "0 to 2, 5, 7 to 8");
    EXPECT_EQ(ranges_of({}), "");
    std::set<int> all;
    for (int id = 0; id < 17; ++id) all.insert(id);
    auto const board = [](int first) {
        return MarkerMap{{}, {{7, 5, 0.045, 0.034, "DICT_4X4_50", first, false, {}}}, {}};
    };
    EXPECT_EQ(compare_ids({{"DICT_4X4_50", all}}, board(0)).problem, "");
    EXPECT_EQ(compare_ids({{"DICT_5X5_50", {44}}}, board(0)).problem, "") << "not of its dictionary";
    for (int const first : {7, 10, 30}) {
        IdFinding const f = compare_ids({{"DICT_4X4_50", all}}, board(first));
        EXPECT_NE(
            f.problem.find("identifiers 0 to 16 of DICT_4X4_50 were seen, the map has " + std::to_string(first)),
            std::string::npos)
            << f.problem;
        EXPECT_EQ(f.remedy, "write first_id: 0 for board 1 (7 x 5 squares)");
    }
    IdFinding const some = compare_ids({{"DICT_4X4_50", {0, 1, 2, 10, 11}}}, board(10));
    EXPECT_EQ(some.problem, "identifiers 0 to 2, 10 to 11 of DICT_4X4_50 were seen, the map has 10 to 26");
    EXPECT_EQ(some.remedy, "") << "too few to tell";
}

} // namespace
} // namespace ar::test
