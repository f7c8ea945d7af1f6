// lightwell display: what it prints, writes and refuses.

#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

TEST(DisplayCommand, ChecksAnExample)
{
    TemporaryFolder const folder;
    run_well("display example cave4.yaml --out cave4.yaml", folder.path());
    EXPECT_EQ(file_text(folder / "cave4.yaml"), file_text(LIGHTWELL_SOURCE_DIR "/data/displays/cave4.yaml"));
    auto const j = nlohmann::json::parse(run_well("display check cave4.yaml --json", folder.path()).out);
    ASSERT_EQ(j["views"].size(), 8u);
    EXPECT_EQ(j["views"][2]["name"], "front, left eye");
    EXPECT_EQ(j["views"][2]["eye_is"], "before");
    EXPECT_NEAR(j["views"][2]["distance_m"].get<double>(), 1.42, 1e-9);
    EXPECT_TRUE(j["report"]["losses"].empty());
    Outcome const text = run_well("display check cave4.yaml", folder.path());
    EXPECT_NE(text.out.find("front, left eye"), std::string::npos);
    EXPECT_NE(text.out.find("tracker head: osc at 127.0.0.1:9000"), std::string::npos);
    EXPECT_TRUE(text.err.empty()) << text.err;
}

TEST(DisplayCommand, ImportsAndSaysWhatIsLost)
{
    TemporaryFolder const folder;
    for (char const* name : {"cave.json", "cave.pvx", "cave.eqc", "cave.cfg", "cave.ndisplay"}) {
        run_well(std::string("display example ") + name + " --out " + name, folder.path());
        Outcome const o = run_well(std::string("display import ") + name + " --out imported.yaml", folder.path());
        bool const says_all = std::string(name) != "cave.pvx" && std::string(name) != "cave.ndisplay";
        EXPECT_EQ(o.err.empty(), says_all) << o.err; // whose head is nowhere, and which says nothing of stereo
        std::string const text = file_text(folder / "imported.yaml");
        EXPECT_TRUE(text.starts_with(std::string("# From ") + name)) << text;
        EXPECT_EQ(text.find("# Not imported, or assumed:\n# - ") == std::string::npos, says_all) << text;
        run_well("display check imported.yaml", folder.path());
        auto const j = nlohmann::json::parse(
            run_well(std::string("display import ") + name + " --out imported.yaml --json", folder.path()).out);
        EXPECT_EQ(j["not_imported"].empty(), says_all) << j;
        EXPECT_EQ(j["report"]["losses"].empty(), says_all) << j;
        EXPECT_GE(j["walls"].get<int>(), 2);
    }
}

TEST(DisplayCommand, WritesTheMapsOfACalibrationBesideTheDisplay)
{
    TemporaryFolder const folder;
    std::vector<unsigned char> const grey(4 * 2 * 3, 128);
    gi::write_png(folder / "blend.png", 4, 2, grey);
    std::string const xml =
        "<MPCDI profile='3d' version='2.0' date=''><display><buffer id='b'><region id='left' xResolution='40' "
        "yResolution='20' x='0' y='0' xsize='1' ysize='1'><frustum><yaw>0</yaw><pitch>0</pitch><roll>0</roll>"
        "<leftAngle>-30</leftAngle><rightAngle>30</rightAngle><downAngle>-20</downAngle><upAngle>20</upAngle>"
        "</frustum></region></buffer></display><files><fileset region='left'><alphaMap><path>blend.png</path>"
        "<gammaEmbedded>2.2</gammaEmbedded></alphaMap></fileset></files></MPCDI>";
    std::ofstream(folder / "mpcdi.xml") << xml;
    Outcome const o = run_well("display import mpcdi.xml --out room.yaml", folder.path());
    EXPECT_NE(o.out.find("1 maps and pictures, from a configuration of MPCDI"), std::string::npos) << o.out;
    EXPECT_EQ(file_text(folder / "room_files/left_blend.png"), file_text(folder / "blend.png"));
    run_well("display check room.yaml", folder.path());
    std::ofstream(folder / "cut.mpcdi") << "PK";
    Outcome const bad = run("display import cut.mpcdi --out cut.yaml", folder.path());
    EXPECT_EQ(bad.code, 2);
    EXPECT_NE(bad.err.find("cut.mpcdi: this is no zip archive"), std::string::npos) << bad.err;
    std::ofstream(folder / "a.ol") << "x";
    EXPECT_EQ(run("display import a.ol --out a.yaml", folder.path()).code, 2);
}

TEST(DisplayCommand, ImportsAPatchOnItsBase)
{
    TemporaryFolder const folder;
    run_well("display example cave.cfg --out Vrui.cfg", folder.path());
    std::ofstream(folder / "patch.cfg")
        << "section Vrui\n  section cave\n    section FrontWall\n      width 60.0\n"
           "    endsection\n  endsection\nendsection\n";
    run_well("display import patch.cfg --base Vrui.cfg --section cave --out out.yaml", folder.path());
    EXPECT_NE(file_text(folder / "out.yaml").find("lower_right_m: [0, 0, -1.524]"), std::string::npos)
        << file_text(folder / "out.yaml");
}

TEST(DisplayCommand, DrawsOnePicturePerCurvedWall)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "d.yaml")
        << "windows: [{name: w, size_px: [200, 200]}]\nworld: {position_m: [1, 2, 3]}\n"
           "users: [{name: u, head_position_m: [0, 0, 0]}]\nwalls:\n"
           "  - {name: dome, window: w, projection: {type: fisheye}}\n";
    Outcome const check = run_well("display check d.yaml", folder.path());
    EXPECT_NE(check.out.find("dome, middle, front face"), std::string::npos) << check.out;
    EXPECT_NE(check.out.find("world: the room's origin is at (1, 2, 3) m"), std::string::npos) << check.out;
    EXPECT_EQ(
        nlohmann::json::parse(run_well("display check d.yaml --json", folder.path()).out)["world"]["yaw_deg"], 0);
    run_well("display calibrate d.yaml --out-dir p", folder.path());
    gi::Picture const grid = gi::read_picture(folder.path() / "p/00_dome.png");
    EXPECT_EQ(grid.width, 200);
    // Azimuth 0 is the line in the middle, green.
    float greenest = 0;
    for (std::size_t x = 97; x < 103; ++x) {
        auto const c = gi::rgb(grid.layers[0], 50 * 200 + x);
        greenest = std::max(greenest, c.y - c.x);
    }
    EXPECT_GT(greenest, 0.3f);
}

TEST(DisplayCommand, DrawsAPicturePerView)
{
    TemporaryFolder const folder;
    run_well("display example desktop3d.yaml --out d.yaml", folder.path());
    run_well("display calibrate d.yaml --pattern crosstalk --out-dir new/pictures", folder.path());
    gi::Picture const left = gi::read_picture(folder.path() / "new/pictures/00_monitor_left_eye.png");
    gi::Picture const right = gi::read_picture(folder.path() / "new/pictures/01_monitor_right_eye.png");
    EXPECT_EQ(left.width, 1920);
    EXPECT_EQ(left.height, 1080);
    std::size_t const upper_right = 300 * 1920 + 1440;
    EXPECT_EQ(gi::rgb(left.layers[0], upper_right).x, 0);
    EXPECT_EQ(gi::rgb(right.layers[0], upper_right).x, 1);
}

TEST(DisplayCommand, RefusesInOneLine)
{
    TemporaryFolder const folder;
    run_well("display example cave.pvx --out cave.pvx", folder.path());
    run_well("display example cave4.yaml --out cave4.yaml", folder.path());
    std::ofstream(folder / "cut.yaml") << "name: cut\n";
    std::ofstream(folder / "cut.ndisplay") << "{\n  \"scene\": [1,";
    std::ofstream(folder / "cut.json") << "{\n  \"nodes\": [1,";
    std::ofstream(folder / "comma.json") << "{\"version\": 1 \"nodes\": []}";
    for (auto const& [arguments, mentions] :
         {std::pair{"display", "subcommand"},
          {"display check cut.yaml", "windows: [{name: front"},
          {"display import cut.json --out x.yaml", "cut.json:2:15: this is not JSON (the text ends too early)"},
          {"display import comma.json --out x.yaml", "comma.json:1:21: this is not JSON"},
          {"display check nowhere.yaml", "nowhere.yaml"},
          {"display check cave.pvx", "cave.pvx:1:1"},
          {"display example cave9.yaml --out x", "there are: "},
          {"display import cave.pvx --out cave.pvx", "cave.pvx"},
          {"display import cave.pvx --section a --out x.yaml", "only configurations of Vrui"},
          {"display import cave.pvx --base cave4.yaml --out x.yaml", "only configurations of Vrui"},
          {"display import cut.ndisplay --out x.yaml", "cut.ndisplay:2:15: this is not JSON"},
          {"display calibrate cave4.yaml --pattern plaid --out-dir x", "grid, corners, eyes"}}) {
        Outcome const o = run(arguments, folder.path());
        EXPECT_EQ(o.code, 2) << arguments;
        EXPECT_NE(o.err.find(mentions), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"cave.pvx", "cave4.yaml", "comma.json", "cut.json",
                                                        "cut.ndisplay", "cut.yaml"}));
}

} // namespace
} // namespace viewer::test
