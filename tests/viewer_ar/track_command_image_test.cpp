// lightwell ar track: why a camera is not found - boards that contradict their map, markers printed twice, markers
// that the map does not have - and lenses that see more than can be rendered.

#include "ar/calibration/calibration_file.h"
#include "ar/markers/marker_map_file.h"
#include "ar/pose/pose_file.h"
#include "tests/ar_markers/drawn_view.h"
#include "tests/viewer/run_program.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

ar::CameraModel const kPinhole{ar::LensModel::pinhole, {640, 480}, 600, 600, 319.5, 239.5, {}};
glm::dvec3 const kEye(0.205, 0.19, 0.42);

/// A session of one frame that shows what is printed, with a map that may differ.
void write_session(std::filesystem::path const& folder, ar::MarkerMap const& printed, ar::MarkerMap const& map,
                   ar::CameraModel const& camera = kPinhole, glm::dvec3 eye = kEye,
                   glm::dvec3 target = {0.13, 0.09, 0})
{
    std::filesystem::create_directories(folder / "frames");
    ar::test::ViewSettings settings;
    settings.rays = 2;
    cv::imwrite((folder / "frames/000000.png").string(),
                ar::test::DrawnWorld(printed, camera, settings).picture(ar::test::looking(eye, target)));
    ar::Calibration calibration;
    calibration.camera = camera;
    ar::write_calibration(folder / "camera.yaml", calibration);
    ar::write_marker_map(folder / "markers.yaml", map);
    std::ofstream(folder / "session.yaml") << "schema: ar/1\nframes: {source: frames, rate_hz: 30}\n"
                                              "camera: camera.yaml\nmarkers: markers.yaml\n";
}

ar::MarkerMap board(int nx, int ny, bool legacy)
{
    return {{}, {{nx, ny, 0.03, 0.022, "DICT_5X5_100", 0, legacy, {}}}, {}};
}
ar::Marker marker(int id, glm::dvec3 at) { return {"DICT_4X4_50", id, 0.08, {at, {1, 0, 0, 0}}}; }

/// The named column of the only row of a table.
std::string cell(std::filesystem::path const& table, std::string const& column)
{
    std::istringstream lines(file_text(table));
    std::string header, row;
    std::getline(lines, header);
    std::getline(lines, row);
    std::istringstream names(header), values(row);
    for (std::string name, value; std::getline(names, name, ',');) {
        value.clear();
        std::getline(values, value, ',');
        if (name == column) return value;
    }
    return "no such column";
}

nlohmann::json stats(std::filesystem::path const& file) { return nlohmann::json::parse(file_text(file)); }

TEST(ArTrack, TrustsNoBoardThatContradictsItsMap)
{
    TemporaryFolder const folder;
    write_session(folder.path(), board(9, 6, true), board(9, 6, false));
    Outcome const o = run("ar track session.yaml --fast --table t.csv --stats s.json", folder.path());
    EXPECT_EQ(o.code, 1) << o.out;
    EXPECT_NE(o.err.find("legacy_pattern: true"), std::string::npos) << o.err;
    EXPECT_NE(o.out.find("1 (board contradicts the map)"), std::string::npos) << o.out;
    EXPECT_EQ(cell(folder / "t.csv", "lost_by"), "board contradicts the map");
    EXPECT_EQ(cell(folder / "t.csv", "boards_left_out"), "1");
    EXPECT_EQ(stats(folder / "s.json")["counts"]["frames without a trusted pose: board contradicts the map"], 1);

    ar::write_marker_map(folder / "markers.yaml", board(9, 6, true));
    run_well("ar track session.yaml --fast --table t.csv", folder.path());
    EXPECT_NEAR(std::stod(cell(folder / "t.csv", "x_m")), kEye.x, 0.002);
    EXPECT_EQ(cell(folder / "t.csv", "lost_by"), "");
}

TEST(ArTrack, CountsMarkersSeenTwiceAndUnknownOnes)
{
    TemporaryFolder const folder;
    ar::MarkerMap const map{{marker(7, {0, 0, 0}), marker(9, {0.12, 0.12, 0})}, {}, {}};
    ar::MarkerMap const twice{{marker(7, {0, 0, 0}), marker(9, {0.12, 0.12, 0}), marker(7, {0.24, 0, 0})}, {}, {}};
    write_session(folder.path(), twice, map);
    Outcome const found = run("ar track session.yaml --fast --table t.csv --stats s.json", folder.path());
    EXPECT_EQ(found.code, 0) << found.err;
    EXPECT_NE(found.out.find("markers whose identifier is in the picture more than once: 2, in 1 frames"),
              std::string::npos)
        << found.out;
    EXPECT_NE(found.err.find("(first: marker 7 of DICT_4X4_50, frame 0)"), std::string::npos) << found.err;
    EXPECT_EQ(cell(folder / "t.csv", "markers_ambiguous"), "2");
    nlohmann::json const found_stats = stats(folder / "s.json");
    auto const& loss =
        found_stats.at("losses").at("markers left out: their identifier is in the picture more than once");
    EXPECT_EQ(loss["count"], 2) << found_stats;

    // Without the other one it is the cause of the loss.
    ar::write_marker_map(folder / "markers.yaml", {{marker(7, {0, 0, 0})}, {}, {}});
    Outcome const lost = run("ar track session.yaml --fast --table t.csv --stats s.json", folder.path());
    EXPECT_EQ(lost.code, 1);
    EXPECT_NE(lost.err.find("mostly: marker identifiers seen twice"), std::string::npos) << lost.err;
    EXPECT_EQ(cell(folder / "t.csv", "lost_by"), "marker identifiers seen twice");
    EXPECT_EQ(cell(folder / "t.csv", "markers_unknown"), "1") << "number 9";

    ar::write_marker_map(folder / "markers.yaml", {{marker(23, {0, 0, 0})}, {}, {}});
    Outcome const unknown = run("ar track session.yaml --fast --table t.csv --stats s.json", folder.path());
    EXPECT_EQ(unknown.code, 1);
    EXPECT_EQ(cell(folder / "t.csv", "lost_by"), "only markers that the map does not have");
    EXPECT_EQ(stats(folder / "s.json")["counts"]["markers that the map does not have"], 3);
}

TEST(ArTrack, UsesFisheyesBeyondWhatIsRendered)
{
    // 130 degrees off the axis in the corners; the board is 50 to 110 degrees off it.
    TemporaryFolder const folder;
    ar::CameraModel const fisheye{ar::LensModel::fisheye, {960, 720}, 250, 250, 479.5, 359.5, {0.01}};
    ar::MarkerMap const map{{}, {{7, 5, 0.04, 0.03, "DICT_4X4_50", 0, false, {}}}, {}};
    glm::dvec3 const eye(0.14, 0.1, 0.16), side(0.75, 0.15, -0.05);
    write_session(folder.path(), map, map, fisheye, eye, eye + side);
    run_well("ar track session.yaml --fast --table t.csv", folder.path());
    EXPECT_NEAR(std::stod(cell(folder / "t.csv", "x_m")), eye.x, 0.003);
    EXPECT_NEAR(std::stod(cell(folder / "t.csv", "z_m")), eye.z, 0.003);
    Outcome const rendered = run("ar run session.yaml --fast", folder.path());
    EXPECT_EQ(rendered.code, 2);
    EXPECT_NE(rendered.err.find("ar track"), std::string::npos) << rendered.err;
    Outcome const lens = run_well("ar lens camera.yaml", folder.path());
    EXPECT_NE(lens.out.find("within 80 degrees of its axis"), std::string::npos) << lens.out;
    EXPECT_NE(lens.out.find("holds over 100 % of the picture, up to 1"), std::string::npos) << lens.out;
    auto const at = lens.out.find("by up to ");
    EXPECT_LT(std::stod(lens.out.substr(at + 9)), 5000) << lens.out;
}

/// More frames for write_session's: from other places.
void add_frames(std::filesystem::path const& folder, ar::MarkerMap const& printed, int frames,
                ar::CameraModel const& camera = kPinhole)
{
    ar::test::ViewSettings settings;
    settings.rays = 2;
    ar::test::DrawnWorld const world(printed, camera, settings);
    for (int i = 1; i < frames; ++i)
        cv::imwrite((folder / fmt::format("frames/{:06}.png", i)).string(),
                    world.picture(ar::test::looking(kEye + 0.05 * i * glm::dvec3(-1, 0.3, 0.2), {0.13, 0.09, 0})));
}

TEST(ArTrack, NamesIdentifiersOfAWrongFirstId)
{
    TemporaryFolder const folder;
    ar::MarkerMap map = board(9, 6, false);
    for (int const first : {9, 40}) { // two rows too low, and none of the map's
        map.boards[0].first_id = first;
        write_session(folder.path(), board(9, 6, false), map);
        Outcome const o = run("ar track session.yaml --fast --stats s.json", folder.path());
        EXPECT_NE(o.err.find(fmt::format("identifiers 0 to 26 of DICT_5X5_100 were seen, the map has {} to {}",
                                         first, first + 26)),
                  std::string::npos)
            << o.err;
        EXPECT_NE(o.err.find("write first_id: 0 for board 1 (9 x 6 squares)"), std::string::npos) << o.err;
        EXPECT_TRUE(stats(folder / "s.json").at("losses").contains("in doubt: identifiers of the map's markers"));
    }
}

TEST(ArTrack, NamesTheDictionaryOfThePictures)
{
    TemporaryFolder const folder;
    ar::MarkerMap map = board(9, 6, false);
    map.boards[0].dictionary = "DICT_6X6_50";
    write_session(folder.path(), board(9, 6, false), map);
    Outcome const o = run("ar track session.yaml --fast", folder.path());
    EXPECT_EQ(o.code, 1);
    EXPECT_NE(o.err.find("markers 0 to 26 of DICT_5X5_"), std::string::npos) << o.err;
}

TEST(ArTrack, SaysHowNearMarkersMustBe)
{
    TemporaryFolder const folder;
    ar::CameraModel const small{ar::LensModel::pinhole, {120, 90}, 112, 112, 59.5, 44.5, {}};
    write_session(folder.path(), board(9, 6, false), board(9, 6, false), small, 3.0 * kEye);
    Outcome const o = run("ar track session.yaml --fast", folder.path());
    EXPECT_EQ(o.code, 1);
    EXPECT_NE(o.err.find("in these pictures of 120 x 90 those of 22 mm have them up to 0.099 m"),
              std::string::npos)
        << o.err;

    gi::RigidPose const pose = ar::test::looking(3.0 * kEye, {0.13, 0.09, 0});
    std::ofstream(folder / "true.csv") << ar::format_poses({{0, pose}});
    Outcome const sized = run("ar track session.yaml --fast --true-poses true.csv", folder.path());
    // 22 mm at 1.4 m and less
    EXPECT_NE(sized.err.find("by the true poses theirs are 2 pixels at most"), std::string::npos) << sized.err;
}

TEST(ArTrack, DoubtsBoardsInMillimetres)
{
    TemporaryFolder const folder;
    ar::MarkerMap map = board(9, 6, false);
    map.boards[0].square_m = 30;
    map.boards[0].marker_m = 22;
    write_session(folder.path(), board(9, 6, false), map);
    Outcome const o = run("ar track session.yaml --fast --stats s.json", folder.path());
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.err.find("is 270 m wide: are its lengths in metres? if it is 270 mm, write 0.27"),
              std::string::npos)
        << o.err;
    EXPECT_NE(o.err.find("in doubt: cameras more than 100 m from their markers: 1"), std::string::npos) << o.err;
    EXPECT_EQ(stats(folder / "s.json").at("losses").at("in doubt: sizes and places of markers").at("count"), 1);
    Outcome const drawn = run("ar board --squares 7x5 --square 45 --marker 34 --out b.svg", folder.path());
    EXPECT_NE(drawn.err.find("315 m wide"), std::string::npos) << drawn.err;
}

TEST(ArTrack, NamesTheFocalLengthThatPicturesContradict)
{
    TemporaryFolder const folder;
    write_session(folder.path(), board(9, 6, false), board(9, 6, false));
    add_frames(folder.path(), board(9, 6, false), 5);
    Outcome const right = run("ar track session.yaml --fast", folder.path());
    EXPECT_EQ(right.err, "");
    ar::Calibration wrong;
    wrong.camera = kPinhole;
    wrong.camera.fx = wrong.camera.fy = 760;
    ar::write_calibration(folder / "camera.yaml", wrong);
    Outcome const o = run("ar track session.yaml --fast --stats s.json", folder.path());
    std::string const words = "the pictures of the markers fit a focal length of ";
    ASSERT_NE(o.err.find(words), std::string::npos) << o.err;
    EXPECT_NEAR(std::stod(o.err.substr(o.err.find(words) + words.size())), 600, 10);
    EXPECT_NE(o.err.find("the calibration has 760"), std::string::npos) << o.err;
}

TEST(ArTrack, DoubtsPosesOfFarMarkers)
{
    TemporaryFolder const folder;
    ar::MarkerMap const map{{marker(7, {0, 0, 0})}, {}, {}};
    write_session(folder.path(), map, map, kPinhole, glm::dvec3(0.9, 0.7, 1.5), {0, 0, 0});
    std::ofstream(folder / "session.yaml", std::ios::app) << "pose: {least_confidence: 0}\n";
    Outcome const o = run("ar track session.yaml --fast --table t.csv --stats s.json", folder.path());
    EXPECT_EQ(o.code, 0) << o.err;
    double const expected_mm = std::stod(cell(folder / "t.csv", "expected_error_mm"));
    EXPECT_NEAR(std::stod(cell(folder / "t.csv", "distance_m")), 1.9, 0.2);
    fmt::print("expected error: {:.1f} mm\n", expected_mm);
    EXPECT_EQ(o.err.find("likely off by more than 5 % of their distance") != std::string::npos, expected_mm > 95)
        << o.err;
    EXPECT_NE(o.out.find("expected error (mm)"), std::string::npos) << o.out;
}

} // namespace
} // namespace viewer::test
