// lightwell view --replay of recordings that the tests make: which pictures of two eyes it writes, of what size, what it
// refuses, and what it says of a scene that has changed.

#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"
#include "viewer/displays/compose.h"
#include "viewer/displays/desktop_views.h"
#include "viewer/engine/scene_files.h"
#include "viewer/protocol/recording/recording.h"

#include <algorithm>

namespace viewer::test {
namespace {

/// A walk of two frames past a window of these pixels. @param files  of the scene
void record(std::filesystem::path const& file, StereoMode mode, glm::ivec2 px,
            std::string const& scene = "cornell", nlohmann::json const& files = {})
{
    RecordingHeader header;
    header.scene = scene;
    header.settings = {
        {"settings", {{"method", "reference"}, {"stereo", name_of(mode)}, {"reuse", 1}, {"denoise", "none"}}}};
    if (!files.is_null()) header.settings["files"] = files;
    gi::Report report;
    Recorder recorder(file, header, report);
    for (int n = 0; n < 2; ++n) {
        RecordedFrame f;
        f.command.frame = std::uint64_t(n);
        f.command.display_s = 0.1 * n;
        f.command.views = desktop_views(gi::look_at({0.278 + 0.05 * n, 0.273, -0.8}, {0.278, 0.273, 0}, 40),
                                        {mode != StereoMode::off, 0.1, 1}, px, eye_size(mode, px));
        recorder.append(f);
    }
    recorder.finish();
}

struct Bytes {
    glm::ivec2 size{0};
    std::vector<float> rgb;
    bool operator==(Bytes const&) const = default;
};
Bytes picture(std::filesystem::path const& file)
{
    gi::Picture const p = gi::read_picture(file);
    return {{p.width, p.height}, p.find("color")->data};
}
/// Columns [from, to).
Bytes columns(Bytes const& p, int from, int to)
{
    Bytes part{{to - from, p.size.y}, {}};
    for (int y = 0; y < p.size.y; ++y)
        part.rgb.insert(part.rgb.end(), p.rgb.begin() + 3 * (y * p.size.x + from),
                        p.rgb.begin() + 3 * (y * p.size.x + to));
    return part;
}

class ReplayCommand : public ::testing::Test {
protected:
    Outcome replay(std::string const& options)
    {
        Outcome const o = run("view --replay walk.lwr " + options, folder.path());
        EXPECT_EQ(o.code, 0) << options << "\n" << o.err;
        return o;
    }
    Bytes written(std::string const& options)
    {
        replay("--out p_%d.png " + options);
        return picture(folder / "p_1.png");
    }
    TemporaryFolder const folder;
};

TEST_F(ReplayCommand, ShowsTheWindowInItsStereoMode)
{
    record(folder / "walk.lwr", StereoMode::side_by_side, {32, 12});
    Bytes const whole = written(""), left = written("--eye left"), right = written("--eye right");
    EXPECT_EQ(whole.size, glm::ivec2(32, 12));
    EXPECT_EQ(left, columns(whole, 0, 16));
    EXPECT_EQ(right, columns(whole, 16, 32));
    EXPECT_NE(left, right);
    EXPECT_EQ(written("--eye both"), whole);
    EXPECT_EQ(written("--size 32x12"), whole); // the window's own size
    Bytes const swapped = written("--set swap_eyes=true");
    EXPECT_EQ(columns(swapped, 0, 16), right);
    EXPECT_EQ(columns(swapped, 16, 32), left);
    replay("--out p_%d.exr");
    EXPECT_EQ(picture(folder / "p_1.exr").size, glm::ivec2(32, 12));
}

TEST_F(ReplayCommand, ShowsItInAnotherMode)
{
    record(folder / "walk.lwr", StereoMode::side_by_side, {32, 12});
    Bytes const red_cyan = written("--set stereo=anaglyph-red-cyan"), left = written("--eye left --size 32x12"),
                right = written("--eye right --size 32x12");
    ASSERT_EQ(red_cyan.size, glm::ivec2(32, 12));
    for (std::size_t i = 0; i < red_cyan.rgb.size(); ++i)
        ASSERT_EQ(red_cyan.rgb[i], (i % 3 == 0 ? left : right).rgb[i]) << i;
}

/// Each file has the size that was asked for, and no picture is stretched.
TEST_F(ReplayCommand, AllPicturesHaveTheSizeAskedFor)
{
    record(folder / "walk.lwr", StereoMode::side_by_side, {32, 12});
    Outcome const o = replay("--out p_%d.png --size 32x32");
    EXPECT_NE(o.err.find("--size 32x12 fits"), std::string::npos) << o.err;
    Bytes const tall = picture(folder / "p_0.png");
    EXPECT_EQ(tall.size, glm::ivec2(32, 32));
    EXPECT_TRUE(std::all_of(tall.rgb.begin(), tall.rgb.begin() + 3 * 32 * 10, [](float v) { return v == 0; }));
    EXPECT_TRUE(std::any_of(tall.rgb.begin() + 3 * 32 * 10, tall.rgb.begin() + 3 * 32 * 11,
                            [](float v) { return v > 0; }));
    Outcome const square = replay("--out p_%d.png --eye left --size 64x24");
    EXPECT_EQ(square.err, "");
    EXPECT_EQ(picture(folder / "p_0.png").size, glm::ivec2(64, 24));
}

TEST_F(ReplayCommand, OneEyesWalkIsAsBefore)
{
    record(folder / "walk.lwr", StereoMode::off, {20, 12});
    EXPECT_EQ(written("").size, glm::ivec2(20, 12));
    EXPECT_EQ(written("--size 12x12").size, glm::ivec2(12, 12));
}

TEST_F(ReplayCommand, RefusesWhatItCannotShow)
{
    record(folder / "walk.lwr", StereoMode::side_by_side, {32, 12});
    std::filesystem::create_directory(folder / "one");
    record(folder / "one" / "walk.lwr", StereoMode::off, {32, 12});
    for (std::string const options :
         {"--out p_%d.png --eye up", "--eye left", "--out p_%d.png --set stereo=off",
          "--out p_%d.exr --set stereo=anaglyph-dubois", "--out p_%d.png --eye left --set swap_eyes=true",
          "--out p_%d.png --eye both --set stereo=rows", "--set eye_distance=0.1", "--set eye-distance=0.1",
          "--set paths=3", "--set scale=0.5", "--set rate=3", "--set auto_exposure=on", "--set play=false",
          "one --out p_%d.png --eye right", "one --out p_%d.png --eye both",
          "one --out p_%d.png --set stereo=side-by-side"}) {
        bool const one = options.starts_with("one ");
        Outcome const o =
            run("view --replay walk.lwr " + options.substr(one ? 4 : 0), one ? folder / "one" : folder.path());
        EXPECT_EQ(o.code, 2) << options;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << options << "\n" << o.err;
    }
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"one", "walk.lwr"}));
    EXPECT_EQ(run("view cornell --eye left", folder.path()).code, 2);
}

/// A room with a material file and a texture.
void write_scene(std::filesystem::path const& folder, std::string const& albedo)
{
    std::ofstream(folder / "quad.obj") << "mtllib quad.mtl\nv -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\n"
                                          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl wall\nf 1/1 2/2 3/3 4/4\n";
    std::ofstream(folder / "quad.mtl") << "newmtl wall\nKd " + albedo + "\nmap_Kd dots.png\n";
}

TEST_F(ReplayCommand, SaysThatTheSceneHasChanged)
{
    std::vector<unsigned char> dots(3 * 4 * 4, 200);
    gi::write_png(folder / "dots.png", 4, 4, dots);
    write_scene(folder.path(), "0.8 0.8 0.8");
    nlohmann::json files;
    for (char const* name : {"quad.obj", "quad.mtl", "dots.png"}) {
        std::vector<std::string> const file{(folder / name).string()};
        files[name] = hashes_of(file).begin()->second;
    }
    record(folder / "walk.lwr", StereoMode::off, {8, 8}, "quad.obj", files);
    record(folder / "older.lwr", StereoMode::off, {8, 8}, "quad.obj");
    std::string const size = "--size 8x8";
    EXPECT_EQ(replay(size).err.find("changed"), std::string::npos);
    write_scene(folder.path(), "0.4 0.4 0.4");
    for (std::string const& options : {std::string(), size}) {
        Outcome const o = replay(options);
        EXPECT_NE(o.err.find("the scene has changed since it was recorded"), std::string::npos) << o.err;
        EXPECT_NE(o.err.find(": quad.mtl\n"), std::string::npos) << o.err;
        EXPECT_NE(o.out.find("the scene has changed since the recording: 1 of its files\n"), std::string::npos);
    }
    dots[5] = 100;
    gi::write_png(folder / "dots.png", 4, 4, dots);
    EXPECT_NE(replay(size).err.find(": dots.png, quad.mtl\n"), std::string::npos);
    Outcome const older = run("view --replay older.lwr", folder.path());
    EXPECT_EQ(older.code, 0);
    EXPECT_EQ(older.err.find("changed"), std::string::npos) << older.err;
}

TEST(SceneFiles, HashesAreOfTheBytes)
{
    TemporaryFolder const folder;
    std::string const a = folder / "a", b = folder / "b", none = folder / "none";
    std::ofstream(a) << "one";
    std::ofstream(b) << "one";
    std::vector<std::string> const files{a, b, none};
    FileHashes hashes = hashes_of(files);
    EXPECT_EQ(hashes.at(a), hashes.at(b));
    EXPECT_EQ(hashes.at(a).size(), 16u);
    EXPECT_EQ(hashes.at(none), "");
    EXPECT_TRUE(changed_files(hashes).empty());
    std::ofstream(b) << "two";
    EXPECT_EQ(changed_files(hashes), std::vector<std::string>{b});
    std::filesystem::remove(a);
    EXPECT_EQ(changed_files(hashes), (std::vector<std::string>{a + " (missing)", b}));
    EXPECT_EQ(file_hashes_from_json(nlohmann::json(hashes)), hashes);
    EXPECT_THROW(file_hashes_from_json(nlohmann::json{{"a", 1}}), gi::InputError);
    EXPECT_THROW(file_hashes_from_json(nlohmann::json("a")), gi::InputError);
}

/// They fit into a recording's header, however many there are.
TEST(SceneFiles, ManyAreCut)
{
    std::vector<std::string> files;
    for (int i = 0; i < 20000; ++i) files.push_back("/nowhere/of_this_test/frame_" + std::to_string(i) + ".ply");
    files.emplace_back("/nowhere/of_this_test/scene.yaml");
    FileHashes const hashes = hashes_of(files);
    EXPECT_TRUE(hashes.contains(files.back()));
    EXPECT_GT(hashes.size(), 1000u);
    EXPECT_LT(nlohmann::json(hashes).dump().size(), std::size_t(300) << 10);
}

} // namespace
} // namespace viewer::test
