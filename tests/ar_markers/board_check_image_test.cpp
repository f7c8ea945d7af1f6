// Maps that the picture contradicts: boards are drawn as one map says, and looked for by another.

#include "ar/markers/detect.h"
#include "tests/ar_markers/drawn_view.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

CameraModel const kView{LensModel::radial_tangential, {640, 480}, 525, 525, 318.5, 243.25, {-0.2, 0.05}};

MarkerMap board(int nx, int ny, bool legacy = false, double marker_m = 0.03)
{
    return {{}, {{nx, ny, 0.04, marker_m, "DICT_4X4_100", 3, legacy, {}}}, {}};
}
MarkerMap grid(int nx, int ny, double gap_m = 0.01)
{
    return {{}, {}, {{nx, ny, 0.03, gap_m, "DICT_4X4_100", 3, {}}}};
}

/// A view of the whole thing, tilted.
cv::Mat picture_of(MarkerMap const& printed, CameraModel const& camera = kView, glm::dvec2 size_m = {0.3, 0.22})
{
    ViewSettings settings;
    settings.rays = 2;
    DrawnWorld const world(printed, camera, settings);
    glm::dvec3 const middle(0.5 * size_m.x, 0.5 * size_m.y, 0);
    return world.picture(looking(middle + glm::dvec3(0.12, 0.1, 0.5), middle));
}

struct Contradiction {
    char const* name;
    MarkerMap printed, map;
    char const* remedy; ///< in the message; empty: the map is right
};

TEST(BoardCheck, NamesWhatContradictsTheMapAndItsRemedy)
{
    for (Contradiction const& c : {
             Contradiction{"even rows, legacy unknown", board(8, 6, true), board(8, 6), "legacy_pattern: true"},
             Contradiction{"the same with odd columns", board(7, 6, true), board(7, 6), "legacy_pattern: true"},
             Contradiction{"legacy by the map alone", board(8, 6), board(8, 6, true), "remove legacy_pattern"},
             Contradiction{"the same with odd columns", board(7, 4), board(7, 4, true), "remove legacy_pattern"},
             Contradiction{"exchanged, odd", board(7, 5), board(5, 7), "squares_x: 7, squares_y: 5"},
             Contradiction{"exchanged, even", board(8, 6), board(6, 8), "squares_x: 8, squares_y: 6"},
             Contradiction{"exchanged, mixed", board(7, 4), board(4, 7), "squares_x: 7, squares_y: 4"},
             Contradiction{"exchanged and legacy", board(8, 6, true), board(6, 8), "legacy_pattern: true"},
             Contradiction{"another number of columns", board(6, 5), board(7, 5), "squares_x: 6"},
             Contradiction{"smaller markers", board(7, 5, false, 0.02), board(7, 5),
                           "measure square_m and marker_m"},
             Contradiction{"a grid", grid(7, 5), board(7, 5), ""},
             Contradiction{"grid exchanged", grid(6, 4), grid(4, 6), "markers_x: 6, markers_y: 4"},
             Contradiction{"grid of other columns", grid(6, 4), grid(5, 4), "markers_x: 6"},
             Contradiction{"grid of another gap", grid(6, 4, 0.015), grid(6, 4), "gap_m"},
         }) {
        Sighting const s = detect(picture_of(c.printed), c.map);
        ASSERT_EQ(s.contradictions.size(), 1u) << c.name;
        EXPECT_NE(s.contradictions[0].find(c.remedy), std::string::npos) << c.name << ": " << s.contradictions[0];
        EXPECT_TRUE(s.points.empty()) << c.name;
        EXPECT_GT(s.markers_seen, 0) << c.name;
    }
}

TEST(BoardCheck, RightMapsAreNeverContradicted)
{
    CameraModel const fisheye{LensModel::fisheye, {640, 480}, 300, 300, 318.5, 243.25, {0.03, -0.01}};
    for (MarkerMap const& map :
         {board(7, 5), board(8, 5), board(7, 6), board(8, 6), board(7, 6, true), board(8, 6, true),
          board(7, 5, true), board(5, 7), board(3, 2), board(7, 5, false, 0.02), board(7, 5, false, 0.036),
          grid(6, 4), grid(2, 5), grid(6, 1), grid(6, 4, 0.03)})
        for (CameraModel const& camera : {kView, fisheye}) {
            Sighting const s = detect(picture_of(map, camera), map);
            EXPECT_TRUE(s.contradictions.empty()) << describe(map, 0) << ": " << s.contradictions[0];
            EXPECT_FALSE(s.points.empty()) << describe(map, 0);
        }
}

/// Something bright covers black squares: no reason to doubt the map.
TEST(BoardCheck, PaperOnTheBoardIsNoContradiction)
{
    MarkerMap const map = board(7, 6);
    cv::Mat picture = picture_of(map);
    for (int x : {0, 150, 300, 450}) {
        cv::Mat covered = picture.clone();
        cv::rectangle(covered, {x, 0, 130, 480}, cv::Scalar(235), cv::FILLED);
        MarkerTracker tracker(map);
        EXPECT_TRUE(tracker.next(picture).contradictions.empty());
        EXPECT_TRUE(tracker.next(covered).contradictions.empty()) << x;
    }
}

TEST(BoardCheck, IsRememberedWhereAPictureCannotTell)
{
    MarkerMap const printed = board(7, 6, true), map = board(7, 6);
    cv::Mat const picture = picture_of(printed);
    // The markers in the middle alone lie as in either map, shifted by a square.
    cv::Mat part(picture.size(), CV_8UC1, cv::Scalar(100));
    cv::Rect const middle(260, 190, 120, 110);
    picture(middle).copyTo(part(middle));
    MarkerTracker tracker(map);
    EXPECT_EQ(tracker.next(picture).contradictions.size(), 1u);
    Sighting const s = tracker.next(part);
    EXPECT_GT(s.markers_seen, 0);
    EXPECT_EQ(s.contradictions.size(), 1u);
    EXPECT_TRUE(s.points.empty());
}

/// Only three in a row give up a board that an earlier picture confirmed.
TEST(BoardCheck, ASingleContradictionGivesUpNoConfirmedBoard)
{
    MarkerMap const map = board(8, 6);
    cv::Mat const right = picture_of(map), wrong = picture_of(board(8, 6, true));
    cv::Mat part(right.size(), CV_8UC1, cv::Scalar(100));
    cv::Rect const middle(260, 190, 120, 110);
    right(middle).copyTo(part(middle));
    MarkerTracker tracker(map);
    for (cv::Mat const& picture : {right, wrong, part, wrong, wrong, right, wrong, wrong}) {
        Sighting const s = tracker.next(picture);
        EXPECT_TRUE(s.contradictions.empty()) << s.contradictions[0];
        EXPECT_GT(s.markers_seen, 0);
    }
    EXPECT_EQ(tracker.next(wrong).contradictions.size(), 1u);
    EXPECT_EQ(tracker.next(wrong).contradictions.size(), 1u);
    EXPECT_TRUE(tracker.next(right).contradictions.empty()) << "confirmed again";
}

TEST(BoardCheck, OtherThingsOfTheMapStay)
{
    MarkerMap printed = board(7, 6, true), map = board(7, 6);
    Marker const lone{"DICT_5X5_50", 7, 0.05, {{0.34, 0.1, 0}, {1, 0, 0, 0}}};
    printed.markers.push_back(lone);
    map.markers.push_back(lone);
    Sighting const s = detect(picture_of(printed), map);
    EXPECT_EQ(s.contradictions.size(), 1u);
    EXPECT_EQ(s.points.size(), 4u);
}

} // namespace
} // namespace ar::test
