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
    for (char const* name : {"cave.json", "cave.pvx", "cave.eqc", "cave.cfg"}) {
        run_well(std::string("display example ") + name + " --out " + name, folder.path());
        Outcome const o = run_well(std::string("display import ") + name + " --out imported.yaml", folder.path());
        EXPECT_EQ(o.err.empty(), std::string(name) != "cave.pvx") << o.err; // whose head is nowhere
        run_well("display check imported.yaml", folder.path());
    }
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
          {"display calibrate cave4.yaml --pattern plaid --out-dir x", "grid, corners, eyes"}}) {
        Outcome const o = run(arguments, folder.path());
        EXPECT_EQ(o.code, 2) << arguments;
        EXPECT_NE(o.err.find(mentions), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
    EXPECT_EQ(folder.files(),
              (std::vector<std::string>{"cave.pvx", "cave4.yaml", "comma.json", "cut.json", "cut.yaml"}));
}

} // namespace
} // namespace viewer::test
