// A map of features from the command line: made with markers, used without.

#include "tests/viewer/run_program.h"

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

void write_map_test(fs::path const& file, std::string const& text) { std::ofstream(file) << text; }

void with_pose(fs::path const& session, std::string const& keys, std::string const& name)
{
    write_map_test(session.parent_path() / name, file_text(session) + "pose: {" + keys + "}\n");
}

TEST(ArMap, FindsTheCameraWithoutMarkers)
{
    TemporaryFolder const folder;
    // The camera moves by 4 cm a frame.
    run_well("ar synthesize walk --quick --frames 14 --size 320x240", folder.path());
    run_well("ar synthesize bare --quick --apart --markers none --frames 14 --size 320x240", folder.path());
    Outcome const made =
        run("ar map walk/session.yaml --poses walk/poses.csv --out map.txt --require-found 100%", folder.path());
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.out.find("camera found in 14 of 14 frames"), std::string::npos) << made.out;
    with_pose(folder / "bare/session.yaml", "features: ../map.txt", "features.yaml");
    cv::imwrite((folder / "bare/frames/000010.png").string(), cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(40)));
    Outcome const o = run("ar track bare/features.yaml --fast --true-poses bare/poses.csv --require-found 90% "
                          "--confidence-table c.csv --table t.csv",
                          folder.path());
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    EXPECT_NE(o.out.find("poses: 13 tracked, 1 held"), std::string::npos) << o.out;
    EXPECT_NE(o.out.find("jumps of more than 20 mm: "), std::string::npos) << o.out;
    EXPECT_EQ(file_text(folder / "c.csv").find("confidence_low,"), 0u);
    std::istringstream values(o.out.substr(o.out.find("position error (mm)") + 19));
    double median_mm = 1e9;
    values >> median_mm;
    EXPECT_LT(median_mm, 10);

    // Albedos are estimated with the camera found in the same way.
    Outcome const albedo = run(
        "ar albedo bare/features.yaml --scene --views 1 --paths 1 --resolution 0.1 --out a.yaml", folder.path());
    EXPECT_EQ(albedo.code, 0) << albedo.err;
    EXPECT_NE(albedo.out.find("camera found in 13 frames (1 without"), std::string::npos) << albedo.out;

    // Markers alone find nothing there.
    EXPECT_EQ(run("ar track bare/session.yaml --fast", folder.path()).code, 1);
    Outcome const nothing = run("ar map bare/session.yaml --out none.txt", folder.path());
    EXPECT_EQ(nothing.code, 1);
    EXPECT_NE(nothing.err.find("no map was written"), std::string::npos) << nothing.err;
    EXPECT_FALSE(fs::exists(folder / "none.txt"));
    EXPECT_EQ(run("ar map walk/session.yaml --out walk/markers.yaml", folder.path()).code, 2) << "it is read";
    write_map_test(folder / "map.txt", "lightwell features 1\n1 2 3\n");
    Outcome const broken = run("ar track bare/features.yaml --fast", folder.path());
    EXPECT_EQ(broken.code, 2);
    EXPECT_NE(broken.err.find("map.txt:2:1"), std::string::npos) << broken.err;
    EXPECT_EQ(run("ar synthesize other --quick --frames 1 --markers two", folder.path()).code, 2);
    EXPECT_EQ(run("ar synthesize other --frames 1 --markers one", folder.path()).code, 2);
}

} // namespace
} // namespace viewer::test
