// What a session reads, and that nothing of it is written over.

#include "viewer/camera_view/session_inputs.h"

#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

void write(fs::path const& file, std::string const& text) { std::ofstream(file) << text; }

class SessionInputs : public testing::Test {
protected:
    SessionInputs()
    {
        for (char const* folder : {"frames", "right", "meshes"}) fs::create_directory(folder_ / folder);
        for (char const* file : {"frames/000000.png", "frames/000001.png", "frames/notes.txt", "right/a7.png",
                                 "meshes/0.obj", "meshes/1.obj"})
            write(folder_ / file, "");
        write(folder_ / "albedo.yaml", "schema: ar-albedo/1\nalbedos:\n"
                                       "  - {name: planes-1, albedo: [0.5, 0.5, 0.5], texture: albedo-1.png}\n");
    }
    std::vector<std::string> files(std::string const& text) const
    {
        std::vector<std::string> names;
        for (fs::path const& f : files_read_by(ar::parse_session(text, folder_ / "s.yaml")))
            names.push_back(fs::relative(f, folder_.path()).string());
        return names;
    }
    TemporaryFolder folder_;
};

TEST_F(SessionInputs, AreAllFilesThatItNames)
{
    using Names = std::vector<std::string>;
    EXPECT_EQ(files(R"(schema: ar/1
frames: {source: frames/%06d.png}
camera: camera.yaml
markers: markers.yaml
light: {map: probe.exr}
real:
  scene: near.glb
  estimates: albedo.yaml
  planes:
    - {corner_m: [0, 0, 0], edge_u_m: [1, 0, 0], edge_v_m: [0, 0, 1], texture: estimate}
    - {corner_m: [0, 0, 0], edge_u_m: [1, 0, 0], edge_v_m: [0, 0, 1], texture: rug.png}
  meshes: [{file: cup.obj}]
  depth: [{file: depth.png, camera: depth.yaml, position_m: [0, 0, 0]}]
virtual: {scene: meshes}
hmd: {right: {source: right/a%d.png, camera: right.yaml, left_from_right: {position_m: [0.06, 0, 0]}}}
)"),
              (Names{"s.yaml", "frames/000000.png", "frames/000001.png", "camera.yaml", "markers.yaml",
                     "probe.exr", "near.glb", "rug.png", "cup.obj", "depth.png", "depth.yaml", "albedo.yaml",
                     "albedo-1.png", "meshes/0.obj", "meshes/1.obj", "right/a7.png", "right.yaml"}));
    EXPECT_EQ(files("schema: ar/1\nframes: {source: clip.mkv}\ncamera: camera.yaml\nmarkers: markers.yaml\n"),
              (Names{"s.yaml", "clip.mkv", "camera.yaml", "markers.yaml"}));
    EXPECT_EQ(files("schema: ar/1\nframes: {source: 'device:0'}\ncamera: camera.yaml\nmarkers: markers.yaml\n"),
              (Names{"s.yaml", "camera.yaml", "markers.yaml"}));
}

TEST_F(SessionInputs, AreTheRecordingOfATrackerToo)
{
    write(folder_ / "walk.csv", "");
    write(folder_ / "room.yaml",
          "windows: [{name: w, size_px: [64, 48]}]\nwalls: [{name: w, window: w, lower_left_m: [-1, 0, 0], "
          "lower_right_m: [1, 0, 0], upper_left_m: [-1, 1, 0]}]\ntrackers: [{name: sensor, type: file, file: "
          "walk.csv, body: camera}]\nusers: [{name: a, head_position_m: [0, 1.7, 0], head_tracker: sensor}]\n");
    EXPECT_EQ(
        files("schema: ar/1\nframes: {source: clip.mkv}\ncamera: camera.yaml\nmarkers: markers.yaml\npose: "
              "{display: room.yaml}\n"),
        (std::vector<std::string>{"s.yaml", "clip.mkv", "camera.yaml", "markers.yaml", "room.yaml", "walk.csv"}));
}

TEST_F(SessionInputs, SayWhichFolderCompositesMustNotGoTo)
{
    EXPECT_EQ(folder_of_source((folder_ / "frames/%06d.png").string()), folder_ / "frames");
    EXPECT_EQ(folder_of_source((folder_ / "frames").string()), folder_ / "frames");
    EXPECT_EQ(folder_of_source((folder_ / "clip.mkv").string()), fs::path());
    EXPECT_EQ(folder_of_source("device:0"), fs::path());
}

} // namespace
} // namespace viewer::test
