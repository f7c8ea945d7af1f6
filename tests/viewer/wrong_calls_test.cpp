// A wrong call or input: exit code 2, one clear message, and no file left behind.

#include "gi/kernel/device.h"
#include "tests/support/processor_time.h"
#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

/// One line "lightwell: problem (why) suggestion" and nothing else.
void expect_refused(std::string const& arguments, std::string const& mentions, std::filesystem::path const& folder)
{
    Outcome const o = run(arguments, folder);
    EXPECT_EQ(o.code, 2) << arguments << "\nsignal " << o.signal << "\n" << o.err;
    EXPECT_TRUE(o.out.empty()) << arguments << "\n" << o.out;
    EXPECT_TRUE(o.err.starts_with("lightwell: ")) << arguments << "\n" << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << arguments << "\n" << o.err;
    EXPECT_NE(o.err.find(mentions), std::string::npos) << arguments << "\n" << o.err;
    EXPECT_NE(o.err.find('('), std::string::npos) << arguments << "\n" << o.err;
}

struct WrongCall {
    char const* arguments;
    char const* mentions;
};

TEST(WrongCalls, LeaveAMessageAndNoFiles)
{
    TemporaryFolder const folder;
    for (WrongCall const call : {
             WrongCall{"", "subcommand"},
             {"paint", "--help"},
             {"paint", "no subcommand 'paint'"},
             {"rendr cornell", "no subcommand 'rendr' (the call is not valid) did you mean 'render'?"},
             {"track lisen", "no subcommand 'lisen' (the call is not valid) did you mean 'listen'?"},
             {"--bogus", "'--bogus' was not expected"},
             {"render", "SCENE"},
             {"render cornell --path 1",
              "'--path' was not expected (the call is not valid) did you mean '--paths'?"},
             {"render cornell --spp 4",
              "'--spp' was not expected (the call is not valid) did you mean '--paths',"},
             {"render --sice=8x8", "'--sice' was not expected (the call is not valid) did you mean '--size'?"},
             {"render cornell more", "more"},
             {"render cornell --bogus", "--bogus"},
             {"render nowhere.glb", "nowhere.glb"},
             {"render .", "folder"},
             {"render cornell --method magic", "magic"},
             {"render cornell --points 64", "--points with --method auto"},
             {"render cornell --method vpl_none --ao-radius 1", "--ao-radius with --method vpl_none"},
             {"render cornell --method vpl_exact --hit-buffer 64", "--hit-buffer"},
             {"render cornell --method vpl_slhb --axes 8", "--axes with --method vpl_slhb"},
             {"render cornell --method vpl_imperfect --points 0%", "--points 0%"},
             {"render cornell --method vpl_imperfect --point-map 100", "--point-map 100"},
             {"render cornell --method vpl_ao --ao-radius -1", "--ao-radius"},
             {"render cornell --method ispm --photons 0", "--photons"},
             {"render cornell --method lpv --photons 100000000", "--photons"},
             {"render cornell --method isllpm --photons 1e3x", "--photons"},
             {"render cornell --method multi_image --photons -5", "--photons"},
             {"render cornell --method lpv --caustic-photons 5", "--caustic-photons with --method lpv"},
             {"render cornell --method multi_image --photon-rays exact",
              "--photon-rays with --method multi_image"},
             {"render cornell --method lpv --propagation-cells 512", "--propagation-cells"},
             {"render cornell --method isllpm --low-cells 1024", "--low-cells"},
             {"render cornell --method isllpm --low-cells 512 --middle-cells 512 --high-cells 512 "
              "--lattice-cascades 4",
              "GiB (at most 8 GiB are supported) choose fewer cells"},
             {"render cornell --method multi_image --impostors 256 --impostor-texels 2048",
              "GiB (at most 8 GiB are supported) choose fewer --impostors"},
             {"render cornell --method ispm --photon-rays impostors --impostors 256 --impostor-texels 2048",
              "GiB"},
             {"render cornell --device tpu", "--device"},
             {"render cornell --method whitted --device cuda", "--device with --method whitted"},
             {"render cornell --axes 4", "--axes with --method auto"},
             {"render cornell --method slhb --schedule stored --axes 4", "--axes with --schedule stored"},
             {"render cornell --method slhb --schedule temporal --directions icosahedron:80", "--directions"},
             {"render cornell --method slhb --directions icosahedron:80 --axes 4", "--directions with --axes"},
             {"render cornell --method slhb --schedule temporal --axes 2 --fresh-axes 4",
              "--fresh-axes is larger than --axes"},
             {"render cornell --method slhb --lamps 2 --fresh-lamps 4",
              "--fresh-light-samples is larger than --light-samples"},
             {"render cornell --size 0x5", "--size"},
             {"render cornell --size 16384x16385", "--size"},
             {"render cornell --camera nobody", "nobody"},
             {"render cornell --look-at 0,0,0", "--look-from"},
             {"render cornell --look-from 0,0", "--look-from"},
             {"render cornell --look-from 1,1,1 --look-at 1,1,1", "direction"},
             {"render cornell --look-from 1e30,0,0", "far"},
             {"render cornell --camera camera --look-from 1,1,1", "--camera"},
             {"render cornell --fov 0", "--fov"},
             {"render cornell --fov nan", "--fov"},
             {"render cornell --aperture-radius -1", "--aperture-radius"},
             {"render cornell --aperture-radius nan", "--aperture-radius"},
             {"render cornell --aperture-radius inf", "--aperture-radius"},
             {"render cornell --aperture-radius 0.1 --focus-distance 0", "--focus-distance"},
             {"render cornell --aperture-radius 0.1 --focus-distance -1", "--focus-distance"},
             {"render cornell --aperture-radius 0.1 --focus-distance nan", "--focus-distance"},
             {"render cornell --aperture-radius 0.1 --focus-distance inf", "--focus-distance"},
             {"render cornell --focus-distance 1", "pinhole"},
             {"render cornell --eye both", "--eye"},
             {"render cornell --eye-distance 0.06", "--eye"},
             {"render cornell --screen-distance 2", "--eye"},
             {"render cornell --eye left --eye-distance -1", "--eye-distance"},
             {"render cornell --eye left --screen-distance 0", "--screen-distance"},
             {"render cornell --time 0 --shutter -1", "--shutter"},
             {"render cornell --time 0 --shutter nan", "--shutter"},
             {"render cornell --time 0 --shutter inf", "--shutter"},
             {"render cornell --shutter 0.1", "--shutter without --time"},
             {"render cornell --time 0 --shutter 0.1 --resume --out a.exr", "--shutter with --resume"},
             {"render cornell --method slhb --frames 0:4@30 --shutter 0.1 --reuse 4", "--shutter with --reuse"},
             {"render cornell --time nan", "--time"},
             {"render cornell --time inf", "--time"},
             {"render cornell --envmap nowhere.exr", "nowhere.exr"},
             {"render cornell --envmap-scale nan", "--envmap-scale"},
             {"render cornell --envmap-rotate nan", "--envmap-rotate"},
             {"render cornell --paths 0", "--paths"},
             {"render cornell --paths -1", "--paths"},
             {"render cornell --paths 1.5", "--paths"},
             {"render cornell --paths 4 --budget 1s", "--budget"},
             {"render cornell --budget 1s --until relmse=1", "--until"},
             {"render cornell --budget soon", "--budget"},
             {"render cornell --until flip=0.1", "--until"},
             {"render cornell --until relmse", "write relmse=0.001"},
             {"render cornell --bounces -1", "--bounces"},
             {"render cornell --filter sinc", "--filter"},
             {"render cornell --denoise median", "--denoise"},
             {"render cornell --denoise atrous --paths 1", "--denoise"},
             {"render cornell --seed -1", "--seed"},
             {"render cornell --seed 18446744073709551616", "--seed"},
             {"generate boxes --seed 18446744073709551616 --out a.glb", "--seed"},
             {"render cornell --out a.png", "'a.png' cannot be an OpenEXR picture"},
             {"render cornell --png a.jpg", "'a.jpg' cannot be a PNG"},
             {"render cornell --frames 0:2@4 --out f_%d.png", "cannot be an OpenEXR picture"},
             {"render cornell --frames 0:2@4 --png f_%d.exr", "cannot be a PNG"},
             {"info --directions icosahedron:20 --png a.exr", "cannot be a PNG"},
             {"generate sky --out sky.hdr", "cannot be an OpenEXR picture"},
             {"generate cornell --out a.obj", "cannot be a binary glTF scene"},
             {"render cornell --threads x", "--threads"},
             {"render cornell --aovs L9", "L9"},
             {"render cornell --aovs L0 L1", "if it belongs to --aovs: its values are joined by commas"},
             {"render cornell --tone neon --png a.png", "--tone"},
             {"render cornell --exposure 1", "--png"},
             {"render cornell --png a.png --exposure nan", "--exposure"},
             {"render cornell --frames 0:4@30 --out f.exr", "%04d"},
             {"render cornell --frames 0:4@30 --out f_%04d.exr --png f.png", "--png 'f.png'"},
             {"render cornell --frames 0:4@30 --out f_%d --png f_%d", "two outputs"},
             {"render cornell --frames 0:12@30 --out f_1%d --png f_%d", "two outputs"},
             {"render cornell --frames 0:4@30 --out nowhere/f_%d.exr", "no folder 'nowhere'"},
             {"render cornell --frames 4:4@30", "no frame"},
             {"render cornell --frames -4:4@30", "--frames"},
             {"render cornell --frames 0:4@nan", "frames per second"},
             {"render cornell --frames 0:4@-1", "frames per second"},
             {"render cornell --frames 0:1000000@30", "at most"},
             {"render cornell --frames 0:4@30 --time 1", "--time with --frames"},
             {"render cornell --frames 0:4@30 --turntable nan", "--turntable"},
             {"render cornell --frames 0:4@30 --turntable --camera-path nowhere.yaml",
              "--camera-path and --turntable"},
             {"render cornell --frames 0:4@30 --camera-path nowhere.yaml", "nowhere.yaml"},
             {"render cornell --look-from 1,1,1 --camera-path nowhere.yaml", "--camera-path and --look-from"},
             {"render cornell --frames 0:4@30 --video a.avi", ".mkv"},
             {"render cornell --frames 0:4@30 --video nowhere/a.mkv", "no folder 'nowhere'"},
             {"render cornell --frames 0:4@30 --size 15x16 --video a.mkv", "even"},
             {"render cornell --frames 0:4@5000 --video a.mkv", "frames per second"},
             {"render cornell --frames 0:4@30 --video a.mkv --resume", "none is saved"},
             {"render cornell --video a.mkv", "--frames"},
             {"render cornell --turntable", "--frames"},
             {"render cornell --seed-per-frame", "--frames"},
             {"render cornell --frames 0:4@30 --png f_%d.png --resume", "--out"},
             {"render cornell --png a.png --half", "--out"},
             {"render cornell --frames 0:4@30 --state s.state", "--state with --frames"},
             {"render cornell --time 0 --shutter 0.1 --state s.state", "--state with --shutter"},
             {"render cornell --checkpoint soon", "--checkpoint"},
             {"render cornell --out a.exr --state a.exr", "two outputs"},
             {"info cornell --size 0x4", "--size"},
             {"info /dev/zero", "it is a device"},
             {"compare", "IMAGE"},
             {"compare a.exr", "REFERENCE"},
             {"compare a.exr b.exr", "a.exr"},
             {"info", "SCENE"},
             {"info nowhere.gltf", "nowhere.gltf"},
             {"info cornell --method magic", "magic"},
             {"info --directions icosahedron:20 --method slhb", "--method with --directions"},
             {"generate", "subcommand"},
             {"generate teapot --out a.glb", "subcommand"},
             {"generate cornell", "--out"},
             {"generate atrium --bays 0 --out a.glb", "bays"},
             {"generate atrium --detail nan --out a.glb", "detail"},
             {"generate boxes --triangles 0 --out a.glb", "triangles"},
             {"generate boxes --triangles 4294967295 --out a.glb", "triangles"},
             {"generate sphere --triangles -3 --out a.glb", "--triangles"},
             {"generate cornell --out nowhere/a.glb", "nowhere"},
             {"generate sky", "--out"},
             {"generate sky --turbidity 1 --out a.exr", "turbidity"},
             {"generate sky --sun-elevation -1 --out a.exr", "elevation"},
             {"generate sky --sun-elevation nan --out a.exr", "elevation"},
             {"generate sky --ground-albedo 2 --out a.exr", "albedo"},
             {"generate sky --ground-albedo green --out a.exr", "--ground-albedo"},
             {"generate sky --size 2x1 --out a.exr", "2 x 1"},
             {"render cornell --background purple", "--background"},
             {"render cornell --background 1,2", "write 0.9,0.5,0.1"},
             {"render cornell --background 1,-2,3", "--background"},
         })
        expect_refused(call.arguments, call.mentions, folder.path());
    EXPECT_TRUE(folder.files().empty()) << testing::PrintToString(folder.files());
}

/// The camera meets what it looks at while the last shutter is open.
TEST(WrongCalls, ACameraPathIsCheckedWhileShuttersAreOpen)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "path.yaml") << "keys:\n"
                                           "  - {time_s: 0, from: [0, 1, 0], at: [2, 1, 0]}\n"
                                           "  - {time_s: 2, from: [2, 1, 0], at: [0, 1, 0]}\n";
    std::string const call = "render cornell --size 8x8 --paths 1 --camera-path path.yaml --out f_%d.exr ";
    expect_refused(call + "--frames 0:2@2 --shutter 0.5", "camera path", folder.path());
    run_well(call + "--frames 0:2@2", folder.path());
}

TEST(WrongCalls, OutputsAreCheckedBeforeTheWork)
{
    TemporaryFolder const folder;
    std::filesystem::create_directory(folder / "sub");
    std::ofstream(folder / "file") << "kept";
    mkfifo((folder / "pipe").c_str(), 0600);
    auto const before = folder.files();
    double const start_s = gi::test::processor_s();
    for (WrongCall const call : {
             WrongCall{"--out nowhere/a.exr", "nowhere"},
             {"--out file/a.exr", "file"},
             {"--out sub", "folder"},
             {"--out pipe", "pipe"},
             {"--out a.exr --png nowhere/a.png", "nowhere"},
             {"--out a.exr --stats nowhere/a.json", "nowhere"},
             {"--out a --png ./a", "two outputs"},
             {"--out a.exr --stats a.exr.state", "two outputs"},
         })
        expect_refused(std::string("render atrium --budget 1h ") + call.arguments, call.mentions, folder.path());
    EXPECT_LT(gi::test::processor_s() - start_s, 30);
    EXPECT_EQ(folder.files(), before);
    EXPECT_EQ(file_text(folder / "file"), "kept");
}

TEST(WrongCalls, OutputsOfAViewAreCheckedBeforeTheSession)
{
    TemporaryFolder const folder;
    for (WrongCall const call : {
             WrongCall{"--stats nowhere/a.json", "no folder 'nowhere'"},
             {"--screenshots nowhere/a", "no folder 'nowhere'"},
             {"--record nowhere/a.lwr", "no folder 'nowhere'"},
             {"--frame-log nowhere/a.csv", "no folder 'nowhere'"},
             {"--stats .", "folder"},
             {"--stats a.lwr --record ./a.lwr", "two outputs"},
         })
        expect_refused(std::string("view cornell ") + call.arguments, call.mentions, folder.path());
    EXPECT_TRUE(folder.files().empty()) << testing::PrintToString(folder.files());
}

TEST(WrongCalls, PointToTheHelpOfWhatWasCalled)
{
    TemporaryFolder const folder;
    for (WrongCall const call : {
             WrongCall{"paint", "see lightwell --help"},
             {"render", "see lightwell render --help"},
             {"recording", "see lightwell recording --help"},
             {"recording export w.lwr", "see lightwell recording export --help"},
             {"track listen --seconds x", "see lightwell track listen --help"},
         })
        expect_refused(call.arguments, call.mentions, folder.path());
}

TEST(WrongCalls, PortsAreWholeNumbers)
{
    TemporaryFolder const folder;
    for (WrongCall const call : {
             WrongCall{"track listen --port 70000", "'70000' is no whole number from 0 to 65535"},
             {"track listen --port -1", "from 0 to 65535"},
             {"track listen --port 9000.5", "from 0 to 65535"},
             {"track send --port 0", "from 1 to 65535"},
         })
        expect_refused(call.arguments, call.mentions, folder.path());
}

TEST(WrongCalls, ADeviceThatIsNotThere)
{
    if (gi::device_present()) GTEST_SKIP() << "SKIPPED: there is a CUDA device";
    TemporaryFolder const folder;
    for (char const* const method : {"slhb", "reference"})
        expect_refused(std::string("render cornell --method ") + method + " --device cuda",
                       gi::kCudaBuild ? "no CUDA device" : "without CUDA", folder.path());
    EXPECT_TRUE(folder.files().empty());
}

TEST(WrongCalls, ADeviceThatCannotBeSimulated)
{
    TemporaryFolder const folder;
    setenv("LIGHTWELL_DEVICE", "simulate", 1); // programs inherit it
    expect_refused("render cornell --device cuda", "LIGHTWELL_DEVICE=simulate", folder.path());
    unsetenv("LIGHTWELL_DEVICE");
}

TEST(WrongCalls, ReadOnlyFolder)
{
    if (geteuid() == 0) GTEST_SKIP() << "SKIPPED: the super-user can write to read-only folders";
    TemporaryFolder const folder;
    std::filesystem::create_directory(folder / "locked");
    std::filesystem::permissions(folder / "locked", std::filesystem::perms::owner_read);
    expect_refused("render atrium --budget 1h --out locked/a.exr", "read-only", folder.path());
}

TEST(WrongCalls, AnInputIsNotOverwritten)
{
    TemporaryFolder const folder;
    run_well("generate sky --size 64x32 --out sky.exr", folder.path());
    std::string const before = file_text(folder / "sky.exr");
    expect_refused("render cornell --envmap sky.exr --size 8x8 --paths 1 --out ./sky.exr", "also an input",
                   folder.path());
    EXPECT_TRUE(file_text(folder / "sky.exr") == before);
}

/// Those, too, that a scene names, which are known once it is loaded.
TEST(WrongCalls, WhatASceneReadsIsNotOverwritten)
{
    TemporaryFolder const folder;
    run_well("generate sky --size 64x32 --out studio_0.exr", folder.path());
    std::string const scene =
        "models: [{generate: {kind: cornell}}]\nenvironment: {file: studio_0.exr, scale: 0.01}\n";
    std::ofstream(folder / "studio.yaml") << scene;
    std::filesystem::create_directory(folder / "sweep");
    std::filesystem::copy(folder / "studio_0.exr", folder / "sweep/room_reference_20ms.exr");
    std::ofstream(folder / "room.yaml") << "models: [{generate: {kind: cornell}}]\n"
                                           "environment: {file: sweep/room_reference_20ms.exr, scale: 0.01}\n";
    std::string const before = file_text(folder / "studio_0.exr");
    for (std::string const call :
         {"render studio.yaml --out studio_0.exr", "render studio.yaml --frames 0:2@4 --out studio_%d.exr",
          "bench sweep --scene room.yaml --methods reference --budgets 20ms --out sweep"})
        expect_refused(call + " --size 8x8", "also an input", folder.path());
    EXPECT_TRUE(file_text(folder / "studio_0.exr") == before);
    EXPECT_TRUE(file_text(folder / "sweep/room_reference_20ms.exr") == before);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"room.yaml", "studio.yaml", "studio_0.exr", "sweep"}));
}

/// Case does not matter, and without an ending every name fits.
TEST(WrongCalls, OtherEndingsAreRight)
{
    TemporaryFolder const folder;
    run_well("render cornell --size 8x8 --paths 1 --out A.EXR --png a", folder.path());
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"A.EXR", "a"}));
}

/// What is refused once frames were to be rendered, is not in the way of the call that is right.
TEST(WrongCalls, RefusedFramesLeaveNoState)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "plan.gltf")
        << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [{"camera": 0},)"
           R"( {"extensions": {"KHR_lights_punctual": {"light": 0}}}], "extensionsUsed": ["KHR_lights_punctual"],)"
           R"( "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional"}]}},)"
           R"( "cameras": [{"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 9}}]})";
    std::string const call = "render plan.gltf --size 8x8 --paths 1 --quiet --frames 0:2@4 --out f_%d.exr ";
    expect_refused(call + "--reuse 4", "--reuse with an orthographic camera", folder.path());
    EXPECT_EQ(folder.files(), std::vector<std::string>{"plan.gltf"});
    run_well(call, folder.path());
}

TEST(WrongCalls, DamagedScenes)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "a.gltf") << "{\"asset\":";
    std::ofstream(folder / "b.glb") << "glTF";
    std::ofstream(folder / "c.obj") << "";
    std::ofstream(folder / "d.yaml") << "models: [";
    std::ofstream(folder / "e.blend1") << "nothing that anybody knows";
    auto const before = folder.files();
    for (std::string const& name : before) {
        expect_refused("info " + name, name, folder.path());
        expect_refused("render " + name + " --paths 1 --size 8x8", name, folder.path());
    }
    EXPECT_EQ(folder.files(), before);
}

} // namespace
} // namespace viewer::test
