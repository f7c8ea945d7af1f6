// What `lightwell render` writes and says.

#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

using Json = nlohmann::json;

constexpr char const* kSmall = "render cornell --size 24x16 --paths 4 ";

bool contains(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

TEST(RenderCommand, WritesWhatItIsAskedFor)
{
    TemporaryFolder const folder;
    Outcome const o = run_well(std::string(kSmall) + "--out a.exr --png a.png --stats a.json", folder.path());
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "a.json", "a.png"}));
    EXPECT_TRUE(contains(o.out, "a.exr\n")) << o.out;
    EXPECT_TRUE(contains(o.out, "24 x 16 pixels, 4 paths each, ")) << o.out;
    EXPECT_TRUE(contains(o.out, "relMSE")) << o.out;
    EXPECT_TRUE(o.err.empty()) << o.err;
    gi::Picture const exr = gi::read_picture(folder / "a.exr"), png = gi::read_picture(folder / "a.png");
    EXPECT_EQ(exr.width, 24);
    EXPECT_EQ(exr.height, 16);
    EXPECT_EQ(exr.layers.size(), 9u);
    EXPECT_EQ(png.width, 24);
    EXPECT_EQ(png.height, 16);
}

TEST(RenderCommand, TransparentPicturesHaveAlpha)
{
    // The room seen from far away: its picture has a rim of nothing.
    TemporaryFolder const folder;
    std::string const call =
        "render cornell --look-from 0.278,0.273,-3 --look-at 0.278,0.273,0 --size 24x24 --paths 8 ";
    run_well(call + "--background transparent --out cut.exr --png cut.png --half", folder.path());
    run_well(call + "--out map.exr", folder.path());
    run_well(call + "--background 0.5,0.25,0.125 --out color.exr", folder.path());
    gi::Picture const cut = gi::read_picture(folder / "cut.exr"), map = gi::read_picture(folder / "map.exr"),
                      color = gi::read_picture(folder / "color.exr");
    gi::Layer const& c = *cut.find("color");
    ASSERT_EQ(c.channels, 4);
    EXPECT_EQ(cut.layers.size(), map.layers.size());
    EXPECT_EQ(c.data[3], 0);
    EXPECT_EQ(c.data[4 * (12 * 24 + 12) + 3], 1);
    EXPECT_EQ(gi::rgb(*color.find("color"), 0), (gi::vec3{0.5f, 0.25f, 0.125f}));
    EXPECT_EQ(cut.metadata.at("command").find("--background transparent") == std::string::npos, false);
    // Without a map, colours are those over black.
    EXPECT_TRUE(
        contains(run_well("compare cut.exr map.exr --metrics relmse --fail-above relmse=1e-5", folder.path()).out,
                 "relmse"));
    // The PNG: 8 bits of red, green, blue and alpha (colour type 6), which compare reads without alpha.
    std::string const png = file_text(folder / "cut.png");
    ASSERT_GT(png.size(), 26u);
    EXPECT_EQ(png[24], 8);
    EXPECT_EQ(png[25], 6);
    EXPECT_EQ(gi::read_picture(folder / "cut.png").find("color")->channels, 3);
    run_well("compare cut.png cut.png", folder.path());
}

TEST(RenderCommand, NamesThePictureAfterTheScene)
{
    TemporaryFolder const folder;
    EXPECT_TRUE(contains(run_well(kSmall, folder.path()).out, "cornell.exr"));
    EXPECT_EQ(folder.files(), std::vector<std::string>{"cornell.exr"});
}

TEST(RenderCommand, KeepsTheLayersAskedFor)
{
    TemporaryFolder const folder;
    run_well("render --aovs L1,depth cornell --size 8x8 --paths 1 --out a.exr --half", folder.path());
    gi::Picture const picture = gi::read_picture(folder / "a.exr");
    EXPECT_EQ(picture.layers.size(), 3u);
    for (char const* name : {"color", "L1", "depth"}) EXPECT_NE(picture.find(name), nullptr) << name;
}

TEST(RenderCommand, ThePictureSaysHowItWasMade)
{
    TemporaryFolder const folder;
    run_well(std::string(kSmall) + "--seed 7 --filter tent --bounces 3 --out a.exr", folder.path());
    gi::Picture const picture = gi::read_picture(folder / "a.exr");
    auto const& m = picture.metadata;
    EXPECT_EQ(m.at("scene"), "cornell");
    EXPECT_EQ(m.at("method"), "paths"); // which auto chose
    EXPECT_EQ(m.at("size"), "24x16");
    EXPECT_EQ(m.at("seed"), "7");
    EXPECT_EQ(m.at("paths"), "4");
    EXPECT_EQ(m.at("bounces"), "3");
    EXPECT_EQ(m.at("filter"), "tent");
    EXPECT_FALSE(m.at("version").empty());
    EXPECT_FALSE(m.at("git").empty());
    EXPECT_TRUE(m.at("level").starts_with("x86-64")) << m.at("level");
    EXPECT_FALSE(m.at("embree").empty());
    // The command alone makes the same file again.
    std::string const command = m.at("command");
    ASSERT_TRUE(command.starts_with("lightwell ")) << command;
    run_well(command.substr(10) + " --out b.exr", folder.path());
    EXPECT_EQ(file_text(folder / "a.exr"), file_text(folder / "b.exr"));
}

TEST(RenderCommand, ThreadsAndOtherOutputsDoNotChangeTheFile)
{
    TemporaryFolder const folder;
    run_well("render cornell --size 40x40 --paths 8 --threads 1 --out one.exr", folder.path());
    run_well("render cornell --size 40x40 --paths 8 --threads 2 --out two.exr --png two.png --json --quiet",
             folder.path());
    run_well("render cornell --size 40x40 --paths 8 --seed 1 --out other.exr", folder.path());
    EXPECT_EQ(file_text(folder / "one.exr"), file_text(folder / "two.exr"));
    EXPECT_NE(file_text(folder / "one.exr"), file_text(folder / "other.exr"));
}

void expect_keys(Json const& j, std::vector<std::string> const& keys, std::string const& help)
{
    for (std::string const& key : keys) {
        EXPECT_TRUE(j.contains(key)) << key;
        EXPECT_TRUE(contains(help, key)) << key << " is not documented";
    }
}

TEST(RenderCommand, StatisticsHaveTheDocumentedKeys)
{
    TemporaryFolder const folder;
    Outcome const o = run_well(std::string(kSmall) + "--stats a.json --json", folder.path());
    Json const j = Json::parse(file_text(folder / "a.json"));
    EXPECT_EQ(j, Json::parse(o.out));
    std::string const help = run_well("render --help", folder.path()).out;
    expect_keys(j, {"schema", "program", "command", "settings", "outputs", "result", "plan", "report"}, help);
    expect_keys(j["result"], {"end", "paths_per_pixel", "seconds", "relmse_estimate", "rays", "rays_per_s"}, help);
    expect_keys(j["report"], {"stages_s", "counts", "losses", "peak_memory_bytes"}, help);
    ASSERT_FALSE(j["plan"].empty());
    expect_keys(j["plan"][0], {"name", "what", "build", "reason", "numbers"}, help);
    EXPECT_EQ(j["schema"], 1);
    EXPECT_EQ(j["result"]["end"], "paths");
    EXPECT_EQ(j["result"]["paths_per_pixel"], 4);
    EXPECT_GT(j["result"]["rays"], 24 * 16 * 4);
    EXPECT_EQ(j["settings"]["width"], 24);
    EXPECT_EQ(j["outputs"]["exr"], "cornell.exr");
    EXPECT_TRUE(j["outputs"]["png"].is_null());
    EXPECT_GT(j["report"]["peak_memory_bytes"], 1 << 20);
    for (char const* stage : {"load", "world", "trace", "save"})
        EXPECT_TRUE(j["report"]["stages_s"].contains(stage)) << stage;
}

TEST(RenderCommand, OnePathKnowsNoError)
{
    TemporaryFolder const folder;
    std::string const call = "render cornell --size 8x8 --paths 1 --out a.exr";
    EXPECT_TRUE(contains(run_well(call, folder.path()).out, "relMSE unknown"));
    EXPECT_TRUE(Json::parse(run_well(call + " --json", folder.path()).out)["result"]["relmse_estimate"].is_null());
}

TEST(RenderCommand, DenoisesAndSaysSo)
{
    TemporaryFolder const folder;
    std::string const call = std::string(kSmall) + "--stats a.json --out ";
    run_well(call + "noisy.exr", folder.path());
    for (std::string const name : {"atrous", "discontinuity"}) {
        Outcome const o = run_well(call + "smooth.exr --denoise " + name, folder.path());
        EXPECT_TRUE(contains(o.out, "before the filter")) << o.out;
        Json const j = Json::parse(file_text(folder / "a.json"));
        EXPECT_EQ(j["settings"]["denoise"], name);
        EXPECT_TRUE(j["report"]["stages_s"].contains("denoise"));
        gi::Picture const noisy = gi::read_picture(folder / "noisy.exr"),
                          smooth = gi::read_picture(folder / "smooth.exr");
        EXPECT_EQ(smooth.metadata.at("denoise"), name);
        EXPECT_TRUE(contains(smooth.metadata.at("command"), "--denoise " + name));
        for (char const* layer : {"color", "L1", "L2"})
            EXPECT_NE(smooth.find(layer)->data, noisy.find(layer)->data) << layer;
        for (char const* layer : {"L0", "albedo", "position", "variance"})
            EXPECT_EQ(smooth.find(layer)->data, noisy.find(layer)->data) << layer;
    }
    EXPECT_TRUE(contains(
        run_well(
            "render cornell --look-from 0.3,0.3,-3 --look-at 0.3,0.3,-9 --denoise atrous --size 8x8 --out a.exr",
            folder.path())
            .err,
        "does nothing"));
}

TEST(RenderCommand, SaysWhatItDecidesForADarkSceneWithoutCamera)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "quad.obj") << "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 4 3 2 1\n";
    Outcome const o = run_well("render quad.obj --size 16x16 --paths 4 --out a.exr", folder.path());
    EXPECT_TRUE(contains(o.err, "note: the scene has no light")) << o.err;
    EXPECT_TRUE(contains(o.err, "note: the scene has no camera")) << o.err;
    gi::Picture const picture = gi::read_picture(folder / "a.exr");
    for (std::size_t i = 0; i < picture.pixels(); ++i)
        EXPECT_GT(gi::max_component(gi::rgb(*picture.find("color"), i)), 0);
    EXPECT_FLOAT_EQ(gi::rgb(*picture.find("L0"), 0).x, 0.2f); // the background in the corner
}

TEST(RenderCommand, SaysWhatIsLost)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "map.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                                      << std::string("\xff\xff\xff\x92\x10\x10\x10\x80", 8);
    Outcome const o =
        run_well("render cornell --envmap map.hdr --look-from 0.3,0.3,-3 --look-at 0.3,5,-3 --size 8x8 --paths 2 "
                 "--half --out a.exr --stats a.json",
                 folder.path());
    EXPECT_TRUE(contains(o.err, "lost: values clamped to half float: ")) << o.err;
    EXPECT_TRUE(contains(o.err, "(first: ")) << o.err;
    Json const losses = Json::parse(file_text(folder / "a.json"))["report"]["losses"];
    EXPECT_GT(losses["values clamped to half float"]["count"], 0) << losses;
}

TEST(RenderCommand, SaysWhatHasNoEffect)
{
    TemporaryFolder const folder;
    std::string const call = "render cornell --size 8x8 --paths 1 --out a.exr ";
    EXPECT_TRUE(contains(run_well(call + "--envmap-rotate -20", folder.path()).err, "do nothing"));
    EXPECT_TRUE(contains(run_well(call + "--resume", folder.path()).err, "starting afresh"));
}

TEST(RenderCommand, NegativeValuesAreValues)
{
    TemporaryFolder const folder;
    run_well("render cornell --look-from -0.1,0.3,-0.9 --size 8x8 --paths 1 --out a.exr --png a.png --exposure -1",
             folder.path());
}

TEST(RenderCommand, GoesOnInInstalments)
{
    TemporaryFolder const folder, whole;
    std::string const call = "render cornell --method reference --size 64x64 --out a.exr";
    run_well(call + " --resume --until relmse=0.05", folder.path());
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "a.exr.state"}));
    run_well(call + " --resume --paths 96", folder.path());
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
    run_well(call + " --paths 96", whole.path());
    EXPECT_TRUE(file_text(folder / "a.exr") == file_text(whole / "a.exr"));
}

TEST(RenderCommand, LightsThatNothingHoldsLightNothing)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "a.obj") << "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wall\nf 1 2 3\n";
    std::ofstream(folder / "a.mtl") << "newmtl lamp\nKe 9 9 9\nnewmtl wall\nKd 0.5 0.5 0.5\n";
    Outcome const o = run_well("render a.obj --size 8x8 --paths 1 --out a.exr", folder.path());
    EXPECT_TRUE(contains(o.err, "the scene has no light: lit by studio lamps")) << o.err;
}

TEST(RenderCommand, StopsAtItsBudget)
{
    TemporaryFolder const folder;
    Outcome const o = run_well("render cornell --size 16x16 --budget 200ms --json --out a.exr", folder.path());
    Json const j = Json::parse(o.out);
    EXPECT_EQ(j["result"]["end"], "budget");
    EXPECT_DOUBLE_EQ(j["settings"]["budget_s"], 0.2);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
}

} // namespace
} // namespace viewer::test
