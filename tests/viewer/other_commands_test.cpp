// info, generate, --version, --help.

#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>
#include <regex>

namespace viewer::test {
namespace {

using Json = nlohmann::json;

TEST(OtherCommands, Version)
{
    TemporaryFolder const folder;
    std::string const text = run_well("--version", folder.path()).out;
    EXPECT_TRUE(std::regex_match(text, std::regex("lightwell [0-9]+\\.[0-9]+\\.[0-9]+ "
                                                  "\\(git ([0-9a-f]{7,}(-dirty)?|unknown), x86-64(-v[234])?, "
                                                  "Embree [34]\\.[0-9]+\\.[0-9]+\\)\n")))
        << text;
}

TEST(OtherCommands, InfoTellsWhatIsBuiltAndWhy)
{
    TemporaryFolder const folder;
    std::string const text = run_well("info cornell", folder.path()).out;
    EXPECT_NE(text.find("triangles"), std::string::npos) << text;
    auto const j = Json::parse(run_well("info cornell --json --time 0.5", folder.path()).out);
    EXPECT_EQ(j["scene"], "cornell");
    EXPECT_TRUE(j["content"]["triangles"].is_number_unsigned());
    EXPECT_TRUE(j["content"]["bounds_m"]["low"][0].is_number_float());
    EXPECT_TRUE(j["content"]["materials"]["mirror"].is_number_unsigned());
    EXPECT_EQ(j["picture"]["memory_bytes"], 512 * 512 * 92);
    EXPECT_GT(j["picture"]["state_file_bytes"], j["picture"]["memory_bytes"]);
    ASSERT_FALSE(j["plan"].empty());
    for (Json const& item : j["plan"]) EXPECT_FALSE(item["reason"].get<std::string>().empty()) << item;
    EXPECT_TRUE(j["report"].contains("losses"));
}

/// render lights a scene without light by lamps of a studio, and builds for it.
TEST(OtherCommands, InfoPlansWhatRenderBuilds)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "t.obj") << "v 0 0 0\nv .5 0 0\nv 0 .5 0\nf 1 2 3\n"; // no light, and numbers without 0
    auto const planned = Json::parse(run_well("info t.obj --json", folder.path()).out);
    auto const built =
        Json::parse(run_well("render t.obj --size 8x8 --paths 1 --json --out t.exr", folder.path()).out);
    EXPECT_EQ(planned["plan"], built["plan"]);
    EXPECT_EQ(planned["content"]["environment_map"]["width_px"], 128);
    EXPECT_TRUE(planned["added_light"].get<std::string>().starts_with("the scene has no light")) << planned;
    EXPECT_EQ(planned["content"]["triangles"], 1);
}

TEST(OtherCommands, InfoTellsWhatMethodsBuild)
{
    TemporaryFolder const folder;
    auto const all = Json::parse(run_well("info cornell --json", folder.path()).out);
    for (char const* const method : {"auto", "paths", "slhb", "sh_grid", "ispm", "lpv", "isllpm", "multi_image"}) {
        Json const& plan = all["plan_" + std::string(method)];
        ASSERT_FALSE(plan.empty()) << method;
        for (Json const& item : plan) EXPECT_FALSE(item["reason"].get<std::string>().empty()) << item;
    }
    auto const some = Json::parse(run_well("info --method lpv,multi_image cornell --json", folder.path()).out);
    EXPECT_TRUE(some.contains("plan_lpv") && some.contains("plan_multi_image"));
    EXPECT_FALSE(some.contains("plan_slhb") || some.contains("plan_ispm"));
    std::string const text = run_well("info mirror --method ispm", folder.path()).out;
    EXPECT_NE(text.find("What method ispm builds"), std::string::npos) << text;
    EXPECT_NE(text.find("smooth triangles"), std::string::npos) << text;
    EXPECT_EQ(text.find("What method slhb builds"), std::string::npos) << text;
}

TEST(OtherCommands, GeneratedScenesAreScenes)
{
    TemporaryFolder const folder;
    std::string const listed = run_well("generate cornell --out room.glb", folder.path()).out;
    EXPECT_EQ(listed, "room.glb\n");
    auto const direct = Json::parse(run_well("info cornell --json", folder.path()).out)["content"];
    auto const saved = Json::parse(run_well("info room.glb --json", folder.path()).out)["content"];
    EXPECT_EQ(direct["triangles"], saved["triangles"]);
    EXPECT_EQ(direct["cameras"], saved["cameras"]);
}

TEST(OtherCommands, GenerateIsDeterministic)
{
    TemporaryFolder const folder;
    run_well("generate boxes --triangles 1200 --seed 3 --out a.glb", folder.path());
    run_well("generate boxes --triangles 1200 --seed 3 --out b.glb", folder.path());
    run_well("generate boxes --triangles 1200 --seed 4 --out c.glb", folder.path());
    EXPECT_TRUE(file_text(folder / "a.glb") == file_text(folder / "b.glb"));
    EXPECT_FALSE(file_text(folder / "a.glb") == file_text(folder / "c.glb"));
}

TEST(OtherCommands, SkyIsSavedBesideTheScene)
{
    TemporaryFolder const folder;
    run_well("generate atrium --bays 1 --detail 0.1 --no-figure --out a.glb", folder.path());
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.glb", "a.yaml", "a_sky.exr"}));
    run_well("info a.yaml", folder.path());
}

TEST(OtherCommands, GenerateReplacesNothingOfOnesOwn)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "x.yaml") << "models: []\n";
    std::string const call = "generate atrium --bays 1 --detail 0.2 --no-figure --out ";
    Outcome const o = run(call + "x.glb", folder.path());
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("x.yaml"), std::string::npos) << o.err;
    std::filesystem::create_directory(folder / "y.yaml");
    EXPECT_EQ(run(call + "y.glb", folder.path()).code, 2);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"x.yaml", "y.yaml"}));
    run_well(call + "z.glb", folder.path());
    run_well(call + "z.glb", folder.path());
}

TEST(OtherCommands, StandardOutputThatIsFullIsNotSuccess)
{
    TemporaryFolder const folder;
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "SKIPPED: no /dev/full here";
    std::string const command =
        "cd " + folder.path().string() + " && " LIGHTWELL_PROGRAM " info cornell > /dev/full 2> err";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
    EXPECT_NE(file_text(folder / "err").find("standard output"), std::string::npos);
}

TEST(Generate, ASkyLightsAScene)
{
    TemporaryFolder const folder;
    Outcome const o =
        run_well("generate sky --turbidity 2.5 --sun-elevation 30 --size 64x32 --out sky.exr", folder.path());
    EXPECT_NE(o.err.find("--envmap-scale 0.0"), std::string::npos) << o.err; // some 20 kcd/m2 from a white floor
    run_well("generate sky --turbidity 2.5 --sun-elevation 30 --size 64x32 --no-sun --out dim.exr", folder.path());
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"dim.exr", "sky.exr"}));
    gi::Picture const sky = gi::read_picture(folder / "sky.exr"), dim = gi::read_picture(folder / "dim.exr");
    ASSERT_EQ(sky.width, 64);
    std::size_t brighter = 0;
    for (std::size_t p = 0; p < sky.pixels(); ++p) {
        float const more = gi::luminance(gi::rgb(*sky.find("color"), p) - gi::rgb(*dim.find("color"), p));
        EXPECT_GE(more, 0);
        brighter += more > 0;
    }
    EXPECT_GT(brighter, 0u);
    EXPECT_LE(brighter, 6u); // the sun is smaller than a texel
    std::ofstream(folder / "a.yaml") << "models: [{generate: {kind: cornell}}]\n"
                                        "environment: {sky: {turbidity: 2.5, sun_elevation: 30, size: [64, 32]}}\n"
                                        "background: [0, 0, 1]\n";
    run_well("render a.yaml --size 8x8 --paths 1 --out a.exr", folder.path());
    run_well("render cornell --envmap sky.exr --size 8x8 --paths 1 --background 0,0,1 --out b.exr", folder.path());
    run_well("compare a.exr b.exr --fail-above relmse=1e-6", folder.path());
}

} // namespace
} // namespace viewer::test
