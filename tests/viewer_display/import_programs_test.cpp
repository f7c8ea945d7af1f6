// What the example files of other programs have: a wall of each format computed by hand, one-eye walls, several
// viewers, patches, projections that are not flat; and refusals that name the construct and its line.

#include "tests/viewer_display/display_samples.h"
#include "viewer/displays/import.h"
#include "viewer/displays/mesh_file.h"
#include "viewer/displays/views.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer::test {
namespace {

void expect_wall(Wall const& wall, gi::dvec3 lower_left, gi::dvec3 lower_right, gi::dvec3 upper_left,
                 double tolerance = 1e-6)
{
    EXPECT_LT(glm::length(wall.corners.lower_left - lower_left), tolerance) << wall.name;
    EXPECT_LT(glm::length(wall.corners.lower_right - lower_right), tolerance) << wall.name;
    EXPECT_LT(glm::length(wall.corners.upper_left - upper_left), tolerance) << wall.name;
}

/// "what (where)" of all that was skipped.
std::string skipped(ImportLog const& log)
{
    std::string out;
    for (SkippedPart const& part : log.parts()) out += part.what + " (" + part.where + ")\n";
    return out;
}

TEST(ImportParaView, MachinesBelowTheRootForOneEyeEach) // CAVEFeatures.pvx
{
    gi::Report report;
    ImportLog const log(report);
    Display const d = parse_pvx(R"(<?xml version="1.0" ?>
<pvx>
  <Machine Name="L" StereoType="Left" Geometry="800x600+10+20" LowerLeft="-2 -1 -2" LowerRight="0 -1 -2" UpperRight="0 1 -2"
    Show2DOverlays="0"/>
  <Machine Name="R" StereoType="Right" LowerLeft="-2 -1 -2" LowerRight="0 -1 -2" UpperRight="0 1 -2"/>
</pvx>)",
                                "c.pvx", log);
    ASSERT_EQ(d.walls.size(), 2u);
    // The fourth corner: lower left + upper right - lower right = (-2, 1, -2).
    expect_wall(d.walls[0], {-2, -1, -2}, {0, -1, -2}, {-2, 1, -2});
    EXPECT_EQ(d.walls[0].eye, Eye::left);
    EXPECT_EQ(d.walls[1].eye, Eye::right);
    EXPECT_EQ(d.windows[0], (DisplayWindow{"L", 800, 600, 10, 20, -1, false, false}));
    EXPECT_EQ(d.users[0].interpupillary_m, 0.065); // ParaView's own
    auto const views = views_of(d, {});
    ASSERT_EQ(views.size(), 2u);
    EXPECT_EQ(views[1].eye, Eye::right);
    EXPECT_EQ(views[1].partner, -1) << "another process draws the left eye";
    EXPECT_NE(skipped(log).find("ParaView Machine.Show2DOverlays: not imported (c.pvx:3)"), std::string::npos);
}

TEST(ImportParaView, SeveralViewers) // TwoViewers.pvx
{
    gi::Report report;
    ImportLog const log(report);
    std::string const corners = R"(LowerLeft="-1 -1 -1" LowerRight="1 -1 -1" UpperRight="1 1 -1"/>)";
    Display const d =
        parse_pvx("<pvx><EyeSeparation Value='0.06'/><IndependentViewers><Viewer Id='1' "
                  "EyeSeparation='0.07'/><Viewer Id='7'/></IndependentViewers>\n<Machine Name='a' "
                  "ViewerId='0' " +
                      corners + "<Machine Name='b' ViewerId='1' ShowBorders='1' " + corners + "</pvx>",
                  "t.pvx", log);
    ASSERT_EQ(d.users.size(), 2u);
    EXPECT_EQ(d.users[0].interpupillary_m, 0.06);
    EXPECT_EQ(d.users[1].interpupillary_m, 0.07);
    EXPECT_EQ(d.walls[1].user, 1);
    EXPECT_TRUE(d.windows[1].borders);
    EXPECT_NE(skipped(log).find("viewers without a machine"), std::string::npos);
    EXPECT_NE(message_of([&] {
                  parse_pvx("<pvx>\n<Machine ViewerId='1' " + corners + "</pvx>", "t.pvx", report);
              }).find("t.pvx:1: no Machine has ViewerId=\"0\""),
              std::string::npos);
}

TEST(ImportParaView, RefusesWhatHasNoCorners) // trivial.pvx, zSpace.pvx, left_right_floor.pvx
{
    gi::Report report;
    auto const message = [&](std::string const& text) {
        return message_of([&] { parse_pvx(text, "t.pvx", report); });
    };
    EXPECT_NE(message("<pvx>\n<Machine Name='m' Geometry='3x3+0+0'/>\n<UseOffAxisProjection Value='false'/></pvx>")
                  .find("machine 'm' has no corners (a plain window there), skipped (t.pvx:2)"),
              std::string::npos);
    EXPECT_NE(message("<pvx>\n<Machine LowerLeft='1 2 3' LowerRight='1 2 0/5' UpperRight='1 2 3'/></pvx>")
                  .find("t.pvx:2: LowerRight=\"1 2 0/5\" of a Machine"),
              std::string::npos);
    // The Process of the server counts, as in ParaView.
    gi::Report other;
    ImportLog const log(other);
    Display const d = parse_pvx(R"(<pvx><Process Type="client"><Machine/></Process>
<Process Type="server"><Machine LowerLeft="-1 -1 -2" LowerRight=" 1 -1 -2" UpperRight="1 1 -2"/></Process></pvx>)",
                                "t.pvx", log);
    EXPECT_EQ(d.walls.size(), 1u);
    EXPECT_NE(skipped(log).find("<Process> beside the chosen Process: not imported (t.pvx:1)"), std::string::npos);
}

std::string equalizer(std::string const& rest)
{
    return "server { config { appNode { pipe { window { viewport [ 0 0 400 200 ] attributes { hint_decoration OFF "
           "}\n"
           "channel { name \"a\" viewport [ 0 0 .5 1 ] } channel { name \"b\" viewport [ .5 0 .5 1 ] } } } }\n" +
           rest + "\n} }";
}

TEST(ImportEqualizer, ProjectionsLieBeforeTheObserver) // 3-window.curved.eqc
{
    // 50 degrees to the left, 3 m away, 54 x 40 degrees: half sizes 3 tan 27 = 1.528576, 3 tan 20 = 1.091911. The
    // middle is 3 (-sin 50, 0, -cos 50) = (-2.298133, 0, -1.928363), the right axis (cos 50, 0, -sin 50): the
    // lower left corner is the middle - 1.528576 (0.642788, 0, -0.766044) - (0, 1.091911, 0).
    gi::Report report;
    Display const d = parse_equalizer(equalizer(R"(canvas { segment { channel "a" viewport [ 0 0 .5 1 ]
        projection { origin [ 0 0 0 ] distance 3 fov [ 54 40 ] hpr [ 50 0 0 ] } } })"),
                                      "c.eqc", report);
    ASSERT_EQ(d.walls.size(), 1u);
    expect_wall(d.walls[0], {-3.280683, -1.091911, -0.757405}, {-1.315583, -1.091911, -3.099320},
                {-3.280683, 1.091911, -0.757405});
    EXPECT_FALSE(d.windows[0].borders);
    // Pitch and roll: 90 degrees up, then the picture's right edge points to the front: origin (0, 1, 0), 1 m away
    // (Equalizer's own distance), 90 x 90 degrees. The middle is (0, 2, 0).
    Display const up = parse_equalizer(
        equalizer(
            R"(canvas { segment { channel "a" projection { origin [ 0 1 0 ] fov [ 90 90 ] hpr [ 0 90 0 ] } } })"),
        "c.eqc", report);
    expect_wall(up.walls[0], {-1, 2, -1}, {1, 2, -1}, {-1, 2, 1});
}

TEST(ImportEqualizer,
     SegmentsOfOneEye) // Passive.stereo.powerwall.eqc, 2-pipe.stereo.passive.eqc, youtube.stereo.eqc
{
    gi::Report report;
    ImportLog const log(report);
    Display const d =
        parse_equalizer(equalizer(R"(observer {} layout { view { mode STEREO observer 0 } } canvas { layout 0
        segment { channel "a" eye [ LEFT CYCLOP ] } segment { channel "b" } }
        compound { channel ( segment 1 view 0 ) eye [ RIGHT ] swapbarrier { NV_group 1 NV_barrier 2 } compound { channel "a" wall {} } })"),
                        "p.eqc", log);
    ASSERT_EQ(d.walls.size(), 2u) << skipped(log);
    EXPECT_EQ(d.walls[0].eye, Eye::left);
    EXPECT_EQ(d.walls[1].eye, Eye::right);
    EXPECT_EQ(d.walls[1].stereo, StereoMode::off);
    expect_wall(d.walls[1], {-.8, -.5, -1}, {.8, -.5, -1}, {-.8, .5, -1}); // Equalizer's own wall
    EXPECT_EQ(views_of(d, {})[1].partner, 0);
}

TEST(ImportEqualizer, MonoSegmentsViewsAndObservers) // 2-channel.stereo.passive.eqc, layout.eqc
{
    gi::Report report;
    ImportLog const log(report);
    Display const d = parse_equalizer(
        equalizer(R"(observer { name "one" } observer { name "two" eye_left [ -.03 0 0 ] eye_right [ .03 0 0 ] }
        layout { name "L" view { mode STEREO viewport [ 0 0 .25 1 ] observer 0 } view { viewport [ .25 0 .75 1 ] observer "two" } }
        canvas { layout "L" swapbarrier { NV_group 2 NV_barrier 1 }
          wall { bottom_left [ -2 0 -1 ] bottom_right [ 2 0 -1 ] top_left [ -2 2 -1 ] }
          segment { channel "a" viewport [ 0 0 .5 1 ] } segment { channel "b" viewport [ .5 0 .5 1 ] eye [ CYCLOP ] } })"),
        "l.eqc", log);
    // The first view has a quarter of the 4 m: x -2 to -1, in half of the first channel (100 of 400 px).
    ASSERT_EQ(d.walls.size(), 3u) << skipped(log);
    expect_wall(d.walls[0], {-2, 0, -1}, {-1, 0, -1}, {-2, 2, -1});
    EXPECT_EQ(viewport_px(d.walls[0], d.windows[0]), (PixelRectangle{0, 0, 100, 200}));
    EXPECT_EQ(d.walls[0].stereo, StereoMode::quad_buffer);
    expect_wall(d.walls[1], {-1, 0, -1}, {0, 0, -1}, {-1, 2, -1});
    EXPECT_EQ(d.walls[1].user, 1);
    EXPECT_EQ(d.walls[2].eye, Eye::middle);
    EXPECT_EQ(d.users[1].interpupillary_m, 0.06);
    EXPECT_EQ(d.windows[0].swap_group, 2);
    EXPECT_EQ(d.windows[0].swap_barrier, 1);
}

TEST(ImportEqualizer, RefusesWithTheLine)
{
    gi::Report report;
    auto const message = [&](std::string const& rest) {
        return message_of([&] { parse_equalizer(equalizer(rest), "f.eqc", report); });
    };
    EXPECT_NE(message("canvas { segment { channel \"a\"\nwall { type HMD } } }") // 2-window.HMD.eqc
                  .find("walls fixed to a head (HMD) skipped (f.eqc:4:1)"),
              std::string::npos);
    EXPECT_NE(message("canvas { segment { channel \"a\" }\nsegment { channel \"a\" } }")
                  .find("f.eqc:4:1: walls 'a' and 'a 2' overlap"),
              std::string::npos);
    EXPECT_NE(message("layout { view { observer 4 } }").find("f.eqc:3:17: there is no observer '4'"),
              std::string::npos);
    EXPECT_NE(
        message("canvas { segment { channel \"a\" viewport [ 0 0 0 1 ] } }").find("a viewport without an area"),
        std::string::npos);
    Display const d = parse_equalizer("global { EQ_NODE_CATTR_LAUNCH_COMMAND_QUOTE '\"' }\n" + // test.eqc
                                          equalizer("canvas { segment { channel \"a\" } }"),
                                      "q.eqc", report);
    EXPECT_EQ(d.walls.size(), 1u);
}

constexpr char const* kVruiBase = R"(section Vrui
  section Desktop
    environmentDefinition Room
    viewerNames (Viewer)
    screenNames (Screen)
    windowNames (Window)
    section Room
      unit (Meter, 1.0)
      up (0.0, 1.0, 0.0)
      forward (0.0, 0.0, -1.0)
    endsection
    section Viewer
      headDeviceTransformation translate (0.0, 1.7, 0.0)
      leftEyePosition (-0.03, 0.0, 0.0)
      rightEyePosition (0.03, 0.0, 0.0)
    endsection
    section Screen
      origin (-1.0, 1.0, -2.0)
      horizontalAxis (1.0, 0.0, 0.0)
      width 2.0
      verticalAxis (0.0, 1.0, 0.0)
      height 1.0
    endsection
    section Window
      windowSize (1280, 720)
      windowType Mono
      screenName Screen
      viewerName Viewer
    endsection
  endsection
endsection
)";

TEST(ImportVrui, PatchesNeedTheirBase) // 1080p.cfg, 3DTV.cfg, FakeHMD.cfg, RiftDK2.cfg, ControlWindow.cfg
{
    gi::Report report;
    std::string const tv = R"(section Vrui
  section Desktop
    section Screen
      width 4.0
    endsection
    section Window
      windowPos (0, 0), (1920, 1080)
      decorate false
      windowType InterleavedViewportStereo
      interleavePattern RRLL
    endsection
  endsection
endsection
)";
    EXPECT_NE(
        message_of([&] { parse_vrui(tv, "3DTV.cfg", "", report); })
            .find(
                "3DTV.cfg:1:1: no environment of this file has screens: it is a patch of a configuration (Vrui "
                "reads it on top of its Vrui.cfg (-mergeConfig); it changes Desktop) give that file with --base"),
        std::string::npos);
    ImportLog const log(report);
    Display const d = parse_vrui({{kVruiBase, "Vrui.cfg"}, {tv, "3DTV.cfg"}}, "Desktop", log);
    ASSERT_EQ(d.walls.size(), 1u);
    // Metres, y up: the origin stays, the width is the patch's.
    expect_wall(d.walls[0], {-1, 1, -2}, {3, 1, -2}, {-1, 2, -2});
    EXPECT_EQ(d.windows[0], (DisplayWindow{"Window", 1920, 1080, 0, 0, -1, false, false}));
    EXPECT_EQ(d.walls[0].stereo, StereoMode::rows);
    EXPECT_FALSE(d.walls[0].swap_eyes); // row 0 from below is the right eye's, so row 1079, our row 0, the left's
    EXPECT_NEAR(d.users[0].head.translation_m.y, 1.7, 1e-12);

    std::string const control = R"(section Vrui
  section Desktop
    viewerNames += (ControlViewer)
    screenNames += (ControlScreen)
    windowNames += (ControlWindow)
    section ControlViewer
      headDeviceTransformation translate (1.0, 1.0, 0.0) * rotate (0.0, 1.0, 0.0), 90.0
      leftEyePosition (-0.03, 0.0, 0.0)
      rightEyePosition (0.03, 0.0, 0.0)
    endsection
    section ControlScreen
      preTransform translate (1.0, 0.0, 0.0) * rotate (0.0, 1.0, 0.0), 90.0
      origin (-2.0, 0.0, -1.0)
      horizontalAxis (1.0, 0.0, 0.0)
      width 4.0
      verticalAxis (0.0, 1.0, 0.0)
      height 2.0
    endsection
    section ControlWindow
      windowSize (800, 400)
      screenName ControlScreen
      viewerName ControlViewer
      windowType SplitViewportStereo
      leftViewportPos (0, 200), (800, 200)
      rightViewportPos (0, 0), (800, 200)
    endsection
  endsection
endsection
)";
    EXPECT_NE(message_of([&] {
                  parse_vrui(control, "ControlWindow.cfg", "", report);
              }).find("ControlWindow.cfg:2:3: environment 'Desktop' names screens, windows or viewers"),
              std::string::npos);
    Display const two = parse_vrui({{kVruiBase, "Vrui.cfg"}, {control, "ControlWindow.cfg"}}, "", report);
    ASSERT_EQ(two.walls.size(), 2u);
    // Turned by 90 degrees about y, (x, y, z) -> (z, y, -x), then moved by 1: (-2, 0, -1) -> (0, 0, 2).
    expect_wall(two.walls[1], {0, 0, 2}, {0, 0, -2}, {0, 2, 2});
    EXPECT_EQ(two.walls[1].stereo, StereoMode::top_bottom);
    Eyes const eyes = eyes_of(two.users[1], resting_head(two.users[1]));
    EXPECT_LT(glm::length(eyes.left - gi::dvec3{1, 1, 0.03}), 1e-12);

    std::string const other = "section Vrui\nsection Vive\nscreenNames += (A)\nendsection\nendsection\n";
    EXPECT_NE(message_of([&] {
                  parse_vrui({{kVruiBase, "Vrui.cfg"}, {other, "FakeHMD.cfg"}}, "Vive", report);
              }).find("environment 'Vive' of the patch stays incomplete (Vrui.cfg does not complete it)"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                  parse_vrui("section VRDevices\nendsection", "VRDevices.cfg", "", report);
              }).find("there is no section Vrui (displays are in one; device, avatar and server files have none)"),
              std::string::npos);
}

TEST(ImportVrui, TwoScreensInOneWindow)
{
    std::string text = kVruiBase;
    auto const put = [&](std::string const& old, std::string const& now) {
        text.replace(text.find(old), old.size(), now);
    };
    put("screenNames (Screen)", "screenNames (Screen, Other)");
    put("windowType Mono\n      screenName Screen",
        "windowType SplitViewportStereo\n      leftScreenName Screen\n      rightScreenName Other");
    put("    section Window\n",
        "    section Other\n      origin (-1.0, 1.0, -2.0)\n      horizontalAxis (1.0, 0.0, 0.0)\n"
        "      verticalAxis (0.0, 1.0, 0.0)\n      width 2.0\n      height 1.0\n    endsection\n"
        "    section Window\n");
    gi::Report report;
    Display const d = parse_vrui(text, "v.cfg", "", report);
    ASSERT_EQ(d.walls.size(), 2u);
    EXPECT_EQ(d.walls[0].eye, Eye::left);
    EXPECT_EQ(viewport_px(d.walls[1], d.windows[0]), (PixelRectangle{640, 0, 640, 720}));
    put("origin (-1.0, 1.0, -2.0)", "deviceMounted true\n      origin (-1.0, 1.0, -2.0)"); // OculusRift.cfg
    put("section Other\n", "section Other\n      deviceMounted true\n");
    EXPECT_NE(message_of([&] {
                  parse_vrui(text, "v.cfg", "", report);
              }).find("Vrui screens carried by a device skipped: only fixed rectangles are imported (v.cfg:17)"),
              std::string::npos);
}

std::string sgct_json(std::string const& viewport, std::string const& window = "", std::string const& node = "")
{
    return "{\"version\": 1, \"masteraddress\": \"m\",\n\"nodes\": [{\"address\": \"a\", \"port\": 1, " + node +
           "\"windows\": [{\"size\": {\"x\": 800, \"y\": 400}" + window + ",\n\"viewports\": [{" + viewport +
           "}]}]}],\n\"users\": [{\"eyeseparation\": 0.06, \"pos\": {\"x\": 0, \"y\": 0, \"z\": 0}}]}";
}

TEST(ImportSgct, FisheyeCylinderAndEquirectangular)
{
    gi::Report report;
    ImportLog const log(report);
    Display const dome =
        parse_sgct(sgct_json(R"("projection": {"type": "FisheyeProjection", "fov": 200, "tilt": 30,
        "diameter": 10, "offset": {"x": 0, "y": 0, "z": 0.2}, "quality": "2k"})",
                             R"(, "border": false)", R"("swaplock": true, )"),
                   "s.json", log);
    ASSERT_EQ(dome.walls.size(), 1u);
    Surface const& s = *dome.walls[0].surface;
    EXPECT_EQ(s.fov_deg, 200);
    EXPECT_EQ(s.radius_m, 5);
    // Tilted by 30 degrees, the middle is 60 degrees above the front; the eye is 0.2 radii towards it from the
    // dome's centre, so that the centre is 1 m behind the room's origin.
    auto const middle = surface_point(s, 2, {0.5, 0.5});
    gi::dvec3 const axis{0, std::sin(glm::radians(60.0)), -std::cos(glm::radians(60.0))};
    EXPECT_LT(glm::length(middle->at - 4.0 * axis), 1e-9);
    EXPECT_NEAR(s.circle->half_width, 0.25, 1e-12) << "800 x 400 px: the circle has 400";
    EXPECT_FALSE(dome.windows[0].borders);
    EXPECT_EQ(dome.windows[0].swap_group, 1);
    EXPECT_NE(skipped(log).find("SGCT projection.quality: not imported (s.json:4:"), std::string::npos);

    Display const cylinder = parse_sgct(
        sgct_json(R"("projection": {"type": "CylindricalProjection", "rotation": 45, "heightoffset": -0.5})"),
        "s.json", report);
    // Its left edge is at 135 - 45 = 90 degrees to the right, half a radius (2.5 m) below the horizon.
    EXPECT_LT(glm::length(surface_point(*cylinder.walls[0].surface, 2, {0, 0})->at - gi::dvec3{5, -2.5, 0}), 1e-9);
    Display const around =
        parse_sgct(sgct_json(R"("projection": {"type": "EquirectangularProjection"})"), "s.json", report);
    double const h = std::sqrt(0.5); // the middle is 45 degrees to the right
    EXPECT_LT(glm::length(surface_point(*around.walls[0].surface, 2, {0.5, 0.5})->at - gi::dvec3{h, 0, -h}), 1e-9);
    EXPECT_EQ(views_of(around, {}).size(), 6u);
    EXPECT_NE(message_of([&] {
                  parse_sgct(sgct_json(R"("projection": {"type": "FisheyeProjection",
"fov": 500})"),
                             "s.json", report);
              }).find("FisheyeProjection: a field of view of 500 degrees"),
              std::string::npos);
    EXPECT_NE(
        message_of([&] { // spout_output_cubemap.json
            parse_sgct(sgct_json(R"("projection": {"type": "CubemapProjection", "spout": {}})"), "s.json", report);
        })
            .find("SGCT viewports with a CubemapProjection, which is not shown in a window, skipped (s.json:3:"),
        std::string::npos);
}

TEST(ImportSgct, SphericalMirrorsWithMeshes) // spherical_mirror_4meshes.json, spherical_mirror.json
{
    auto const folder = std::filesystem::temp_directory_path() / "lightwell_mirror_test";
    std::filesystem::create_directories(folder);
    // A grid of 3 x 2 nodes; x from -2 to 2 in a window of 2 : 1.
    std::string obj;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 3; ++i)
            obj += fmt::format("v {} {} 0\nvt {} {}\n", 2.0 * i - 2, 2.0 * j - 1, i / 2.0, j / 1.0);
    obj += "f 1/1 2/2 5/5\nf 1/1 5/5 4/4\nf 2/2 3/3 6/6\nf 2/2 6/6 5/5\n";
    gi::write_text(folder / "m.obj", obj);
    gi::write_text(folder / "b.data", "2\n2 2\n-2 -1 0 0 1\n2 -1 1 0 0.5\n-2 1 0 1 1\n2 1 1 1 -1\n");
    std::string const name = (folder / "s.json").string();
    gi::Report report;
    ImportLog const log(report);
    Display const four = parse_sgct(sgct_json(R"("projection": {"type": "SphericalMirrorProjection", "tilt": 0,
        "geometry": {"bottom": "m.obj", "left": "m.obj", "right": "gone.obj", "top": "m.obj"}})"),
                                    name, log);
    ASSERT_EQ(four.walls.size(), 3u) << skipped(log);
    // The front face is looked at 45 degrees upward, 1.2 m away: its middle is at 1.2 (0, h, -h), h = sqrt(1/2),
    // and its lower edge 1.2 (0, h, h) below that: at y = 0, z = -2.4 h.
    expect_wall(four.walls[0], {-1.2, 0, -2.4 * std::sqrt(0.5)}, {1.2, 0, -2.4 * std::sqrt(0.5)},
                {-1.2, 2.4 * std::sqrt(0.5), 0});
    EXPECT_EQ(four.walls[0].warp->columns, 3);
    EXPECT_EQ(four.walls[0].warp->node(1, 1).place, glm::dvec2(0.5, 1));
    EXPECT_NE(skipped(log).find("gone.obj"), std::string::npos);
    Display const bourke =
        parse_sgct(sgct_json(R"("mesh": "b.data", "projection": {"type": "FisheyeProjection"})"), name, report);
    EXPECT_NEAR(bourke.walls[0].warp->node(1, 0).weight, std::pow(0.5, 2.2), 1e-12);
    EXPECT_EQ(bourke.walls[0].warp->node(1, 1).weight, 0);
    EXPECT_NE(message_of([&] {
                  parse_sgct(sgct_json(R"("mesh": "x.pfm", "projection": {"type": "FisheyeProjection"})"), name,
                             report);
              }).find("a mesh of kind '.pfm'"),
              std::string::npos);
    EXPECT_NE(message_of([] {
                  parse_mesh_file("v 0 0 0\nvt 0 0\nv 1 0 0\nvt 1 0\nv 0 1 0\nvt 0 1\nf 1 2 3\n", "t.obj", 1);
              }).find("t.obj:7: the faces are no grid"),
              std::string::npos);
    EXPECT_NE(
        message_of([] { parse_mesh_file("2\n2 2\n0 0 0\n", "t.data", 1); }).find("t.data:3: 1 nodes instead of 4"),
        std::string::npos);
    std::filesystem::remove_all(folder);
}

TEST(ImportSgct, TheOlderXml) // 3DTV_old.xml, single_fisheye.xml, ...
{
    gi::Report report;
    ImportLog const log(report);
    Display const d = parse_sgct_xml(R"(<?xml version="1.0" ?>
<Cluster masterAddress="localhost">
 <Scene><Offset x="0" y="0" z="-2"/><Orientation yaw="90"/></Scene>
 <Node address="localhost" port="20400" swapLock="true">
  <Window fullScreen="true" msaa="4" border="false"><Stereo type="none"/><Pos x="5" y="6"/><Size x="1920" y="1080"/>
   <Viewport eye="left"><Pos x="0.0" y="0.0"/><Size x="0.5" y="1.0"/><Projectionplane>
     <Pos x="-2" y="-1" z="0"/><Pos x="-2" y="1" z="0"/><Pos x="2" y="1" z="0"/></Projectionplane></Viewport>
   <Viewport eye="right"><Pos x="0.5" y="0.0"/><Size x="0.5" y="1.0"/><PlanarProjection>
     <FOV left="45" right="45" up="45" down="45"/><Orientation heading="90" pitch="0" roll="0"/></PlanarProjection></Viewport>
  </Window>
  <Window><Size x="512" y="512"/><Fisheye fov="180" tilt="90"/></Window>
 </Node>
 <User eyeSeparation="0.06"><Pos x="0" y="0" z="4"/></User>
</Cluster>)",
                                     "o.xml", log);
    ASSERT_EQ(d.walls.size(), 3u) << skipped(log);
    expect_wall(d.walls[0], {-2, -1, 0}, {2, -1, 0}, {-2, 1, 0});
    EXPECT_EQ(d.walls[0].eye, Eye::left);
    expect_wall(d.walls[1], {10, -10, -10}, {10, -10, 10}, {10, 10, -10}); // 10 m to the right
    EXPECT_EQ(d.walls[1].eye, Eye::right);
    EXPECT_LT(glm::length(surface_point(*d.walls[2].surface, 1, {0.5, 0.5})->at - gi::dvec3{0, 0, -7.4}), 1e-9);
    EXPECT_EQ(d.windows[0], (DisplayWindow{"window", 1920, 1080, 5, 6, -1, true, false, 1, 1}));
    EXPECT_EQ(d.users[0].head.translation_m, (gi::dvec3{0, 0, 4}));
    // The scene is turned to the right and moved 2 m to the front: its origin is at (0, 0, -2) of the room, so the
    // room's origin lies 2 m along +z of the room from it, which is the scene's +x... turned back by 90 degrees.
    ASSERT_TRUE(d.world);
    gi::dvec3 const scene_origin_in_room{0, 0, -2};
    EXPECT_LT(glm::length(gi::dvec3(world_from_room(*d.world) * glm::dvec4(scene_origin_in_room, 1))), 1e-12);
    // What the room sees in front (-z) is the scene's direction before the turn by yaw to the right.
    gi::dvec3 const seen = glm::dmat3(world_from_room(*d.world)) * gi::dvec3{1, 0, 0};
    EXPECT_LT(glm::length(seen - gi::dvec3{0, 0, -1}), 1e-12) << "the scene's -z appears to the right";
    EXPECT_NE(skipped(log).find("SGCT Window.msaa: not imported (o.xml:5)"), std::string::npos);
    auto const message = [&](std::string const& text) {
        return message_of([&] { parse_sgct_xml(text, "o.xml", report); });
    };
    EXPECT_NE(message("<Cluster><Node>\n<Window mpcdi='a.mpcdi'><Size x='9' y='9'/></Window></Node></Cluster>")
                  .find("SGCT windows with MPCDI, which is not supported, skipped (o.xml:2)"),
              std::string::npos);
    EXPECT_NE(message("<a/>").find("there is no element <Cluster>"), std::string::npos);
    EXPECT_NE(message("<Cluster><Node><Window><Size x='1' y='1'/><Viewport>\n<Viewplane><Pos x='1' y='1' "
                      "z='1'/></Viewplane></Viewport></Window></Node></Cluster>")
                  .find("o.xml:2: <Viewplane> has 1 corners"),
              std::string::npos);
    EXPECT_NE(message("<Cluster><Node><Window><Size x='9' y='9'/>\n<Viewport mesh='c.sgc'><FisheyeProjection/>"
                      "</Viewport></Window></Node></Cluster>")
                  .find("whose mesh cannot be read, skipped: c.sgc: a mesh of kind '.sgc'"),
              std::string::npos);
}

std::string ndisplay_json(std::string const& policy, std::string const& parent = "right")
{
    return R"({"nDisplay": {"version": "5.00", "scene": {
"xforms": {"center": {"parentId": "", "location": {"x": 0, "y": 0, "z": 100}, "rotation": {"pitch": 0, "yaw": 0, "roll": 0}},
  "right": {"parentId": "center", "location": {"x": 0, "y": 150, "z": 0}, "rotation": {"pitch": 0, "yaw": 90, "roll": 0}}},
"cameras": {"L": {"interpupillaryDistance": 6.4, "stereoOffset": "left", "parentId": "", "location": {"x": 10, "y": 0, "z": 170}},
            "R": {"interpupillaryDistance": 6.4, "stereoOffset": "right", "parentId": "", "location": {"x": 10, "y": 0, "z": 170}}},
"screens": {"s": {"size": {"width": 300, "height": 200}, "parentId": ")" +
           parent + R"(", "location": {"x": 0, "y": 0, "z": 0}}}},
"cluster": {"sync": {"renderSyncPolicy": {"type": "Nvidia"}}, "nodes": {"n": {"host": "h", "fullScreen": true,
 "window": {"x": 1, "y": 2, "w": 1600, "h": 400}, "viewports": {
  "l": {"camera": "L", "bufferRatio": 0.5, "region": {"x": 0, "y": 0, "w": 600, "h": 400}, "projectionPolicy": {"type": "Simple", "parameters": {"screen": "s"}}},
  "r": {"camera": "R", "region": {"x": 600, "y": 0, "w": 600, "h": 400},
   "projectionPolicy": {"type": ")" +
           policy + R"(", "parameters": {"screen": "s"}}}}}}}}})";
}

TEST(ImportNDisplay, Json)
{
    gi::Report report;
    ImportLog const log(report);
    Display const d = parse_ndisplay(ndisplay_json("simple"), "n.ndisplay", log);
    ASSERT_EQ(d.walls.size(), 2u) << skipped(log);
    // 150 cm to the right, facing left: yaw 90 degrees turns x forward to y (right) and y to -x (backward). Its
    // left edge is 150 cm before the middle: (x, y, z) = (150, 150, 0) cm; with z from 0 to 200. Ours: (y, z, -x).
    expect_wall(d.walls[0], {1.5, 0, -1.5}, {1.5, 0, 1.5}, {1.5, 2, -1.5});
    EXPECT_EQ(d.walls[0].eye, Eye::left);
    EXPECT_EQ(d.walls[1].eye, Eye::right);
    ASSERT_EQ(d.users.size(), 1u) << "two cameras of one head";
    EXPECT_LT(glm::length(d.users[0].head.translation_m - gi::dvec3{0, 1.7, -0.1}), 1e-12);
    EXPECT_NEAR(d.users[0].interpupillary_m, 0.064, 1e-12);
    EXPECT_EQ(d.walls[0].render_width_px, 300);
    EXPECT_EQ(d.windows[0], (DisplayWindow{"n", 1600, 400, 1, 2, -1, true, false, 1, 1}));
    for (char const* policy : {"mesh", "domeprojection", "easyblend", "camera", "manual"}) {
        gi::Report other;
        ImportLog const skips(other);
        EXPECT_EQ(parse_ndisplay(ndisplay_json(policy), "n.ndisplay", skips).walls.size(), 1u);
        EXPECT_NE(skipped(skips).find(std::string("nDisplay projection policy ") + policy +
                                      ": not supported, viewport skipped"),
                  std::string::npos)
            << skipped(skips);
    }
    EXPECT_NE(message_of([&] {
                  parse_ndisplay(ndisplay_json("simple", "gone"), "n.ndisplay", report);
              }).find("n.ndisplay:6:18: there is no parent 'gone'"),
              std::string::npos);
    EXPECT_NE(message_of([&] { parse_ndisplay("{\"nDisplay\": {}}", "n.ndisplay", report); }).find("scene"),
              std::string::npos);
    std::string circle = ndisplay_json("simple");
    circle.replace(circle.find("\"parentId\": \"\""), 14, "\"parentId\": \"right\"");
    EXPECT_NE(
        message_of([&] { parse_ndisplay(circle, "n.ndisplay", report); }).find("parents go round in a circle"),
        std::string::npos);
}

/// An observer with these fields.
std::string equalizer_with(std::string const& observer, std::string const& more = "")
{
    return "global { EQ_CONFIG_FATTR_EYE_BASE 0.06 EQ_COMPOUND_IATTR_STEREO_MODE PASSIVE }\n"
           "server { config { appNode { pipe { window { viewport [ 0 0 200 100 ] channel { name \"l\" viewport [ "
           "0 0 .5 1 "
           "] } channel { name \"r\" viewport [ .5 0 .5 1 ] } } } }\n"
           "observer { " +
           observer +
           " }\nlayout { name \"s\" view { mode STEREO observer 0 } } canvas { layout \"s\" wall { } segment { "
           "eye [ LEFT ] "
           "channel \"l\" } segment { eye [ RIGHT ] channel \"r\" } } " +
           more + " } }";
}

/// Where the eyes of the resting head are.
void expect_eyes(User const& user, gi::dvec3 left, gi::dvec3 right)
{
    Eyes const eyes = eyes_of(user, resting_head(user));
    EXPECT_LT(glm::length(eyes.left - left), 1e-12) << eyes.left.x << " " << eyes.left.y << " " << eyes.left.z;
    EXPECT_LT(glm::length(eyes.right - right), 1e-12)
        << eyes.right.x << " " << eyes.right.y << " " << eyes.right.z;
}

TEST(ImportEqualizer, EyesAreWhereTheFileSays) // Equalizer's issue 201
{
    struct Case {
        std::string observer;
        gi::dvec3 left, right;
        std::vector<std::string> lost; ///< in the order of the file
    };
    std::string const unlevel = "eyes at different heights", apart = "eyes of pictures without stereo";
    for (auto const& [observer, left, right, lost] :
         {Case{"", {-.03, 0, 0}, {.03, 0, 0}, {}}, Case{"eye_base 0.07", {-.035, 0, 0}, {.035, 0, 0}, {}},
          Case{"eye_left [ -.04 .01 0 ] eye_right [ .03 0 0 ]", {-.04, .01, 0}, {.03, 0, 0}, {unlevel, apart}},
          Case{"eye_left [ -.04 .01 0 ] eye_cyclop [ -.005 .005 0 ] eye_right [ .03 0 0 ]",
               {-.04, .01, 0},
               {.03, 0, 0},
               {unlevel}},
          Case{"eye_left [ -.03 -.02 .01 ] eye_right [ .03 .02 -.01 ]",
               {-.03, -.02, .01},
               {.03, .02, -.01},
               {unlevel}},
          Case{"eye_left [ -.03 0 .01 ] eye_right [ .03 0 -.01 ]", {-.03, 0, .01}, {.03, 0, -.01}, {}},
          Case{"eye_left [ 0 -.03 0 ] eye_right [ 0 .03 0 ]", {0, -.03, 0}, {0, .03, 0}, {unlevel}},
          Case{"eye_left [ .03 0 0 ] eye_right [ -.03 0 0 ]",
               {.03, 0, 0},
               {-.03, 0, 0},
               {"eyes of which the right one"}},
          Case{"eye_left [ -.04 .1 .2 ] eye_right [ .02 .1 .2 ] eye_cyclop [ -.01 .1 .2 ]",
               {-.04, .1, .2},
               {.02, .1, .2},
               {}},
          Case{"eye_left [ -.04 0 0 ] eye_base 0.07", {-.035, 0, 0}, {.035, 0, 0}, {}}}) {
        gi::Report report;
        ImportLog const log(report);
        Display const d = parse_equalizer(equalizer_with(observer), "e.eqc", log);
        ASSERT_EQ(d.walls.size(), 2u);
        expect_eyes(d.users[0], left, right);
        ASSERT_EQ(log.parts().size(), lost.size()) << observer << "\n" << skipped(log);
        for (std::size_t i = 0; i < lost.size(); ++i) {
            EXPECT_TRUE(log.parts()[i].what.starts_with(lost[i])) << observer << "\n" << skipped(log);
            EXPECT_TRUE(log.parts()[i].where.starts_with("e.eqc:3:1")) << log.parts()[i].where;
        }
    }
}

/// Settings that the importers read over, or averaged.
TEST(ImportPrograms, WhatIsNotImportedIsNamed)
{
    struct Case {
        Display (*parse)(std::string const&, std::string const&, ImportLog);
        std::string text, lost;
    };
    auto const vrui = [](std::string const& text, std::string const& name, ImportLog log) {
        return parse_vrui(text, name, "", log);
    };
    auto const vrui_text = [](std::string const& viewer, std::string const& window) {
        return "section Vrui\nsection a\nscreenNames (S)\nwindowNames (W)\nsection S\norigin (-1, 1, "
               "0)\nhorizontalAxis (1, "
               "0, 0)\nverticalAxis (0, 0, 1)\nwidth 60\nheight 60\nendsection\nsection W\nwindowPos (0, 0), (80, "
               "60)\nscreenName S\nviewerName V\n" +
               window + "\nendsection\nsection V\nleftEyePosition (-1.25, 0, 0)\nrightEyePosition (1.25, 0, 0)\n" +
               viewer + "\nendsection\nendsection\nendsection\n";
    };
    auto const ndisplay = [](std::string const& node, std::string const& viewport, std::string const& camera,
                             std::string const& top = "") {
        return R"({"nDisplay": {)" + top + R"("scene": {"xforms": {}, "cameras": {"c": {)" + camera +
               R"("location": {"x": 0, "y": 0, "z": 170}}}, "screens": {"s": {"size": {"width": 300, "height": 200}}}},
               "cluster": {"nodes": {"n": {)" +
               node + R"("window": {"x": 0, "y": 0, "w": 80, "h": 60}, "viewports": {"v": {)" + viewport +
               R"("camera": "c", "region": {"x": 0, "y": 0, "w": 80, "h": 60},
               "projectionPolicy": {"type": "simple", "parameters": {"screen": "s"}}}}}}}}})";
    };
    auto const ndisplay_text = [](std::string const& more, std::string const& camera = "") {
        return "[cluster_node] id=n window=w\n[window] id=w viewports=v ResX=80 ResY=60\n[viewport] id=v x=0 y=0 "
               "width=80 "
               "height=60 projection=p\n[projection] id=p type=simple screen=s\n[screen] id=s loc=\"X=1,Y=0,Z=1\" "
               "size=\"X=3,Y=2\"\n[camera] id=c loc=\"X=0,Y=0,Z=1.7\" " +
               camera + "\n" + more;
    };
    auto const sgct_text = [](std::string const& node, std::string const& window, std::string const& projection) {
        return R"({"version": 1, "masteraddress": "localhost", "users": [{"pos": {"x": 0, "y": 0, "z": 0}}], "nodes": [{"port": 1, )" +
               node + R"("windows": [{"size": {"x": 80, "y": 60})" + window +
               R"(, "viewports": [{"projection": )" + projection + "}]}]}]}";
    };
    std::string const plane = R"({"type": "PlanarProjection", "fov": {"hfov": 90, "vfov": 90}})";
    constexpr char const* kUsual[]{"screens whose size", "ParaView does not say",
                                   "nDisplay is told on its command line", "windows that show no wall"};
    for (auto const& [parse, text, lost] :
         {Case{parse_equalizer, equalizer_with("focus_distance 2"),
               "Equalizer observer focus_distance: not imported"},
          Case{parse_equalizer, equalizer_with("", "compound { attributes { stereo_mode HOLOGRAM } }"),
               "Equalizer stereo_mode HOLOGRAM: not imported"},
          Case{parse_equalizer, equalizer_with("", "node { host \"far\" pipe { device 0 } }"),
               "addresses of machines"},
          Case{parse_equalizer, equalizer_with("", "node { pipe { device 1 } }"),
               "Equalizer pipe device: not imported"},
          Case{parse_equalizer, equalizer_with("", "node { pipe { attributes { hint_thread OFF } } }"),
               "Equalizer pipe attributes: not imported"},
          Case{parse_equalizer,
               equalizer_with("", "node { pipe { window { viewport [ 0 0 9 9 ] channel { name \"x\" attributes { "
                                  "hint_statistics OFF } } } } }"),
               "Equalizer channel attributes: not imported"},
          Case{vrui, vrui_text("monoEyePosition (0, 0, 1)", ""), "eyes of pictures without stereo"},
          Case{vrui, vrui_text("viewDirection (0, 1, 0.5)", ""), "Vrui view directions"},
          Case{vrui, vrui_text("headLightColor (1, 1, 1)", ""), "Vrui lamps at the head"},
          Case{vrui, vrui_text("", "display :0.1"), "Vrui displays of windows"},
          Case{vrui,
               vrui_text("viewDirection (0, 1, 0)\nmonoEyePosition (0, 0, 0)\nheadLightEnabled false",
                         "display :0.0"),
               ""},
          Case{parse_ndisplay, ndisplay("", "", ""), ""},
          Case{parse_ndisplay, ndisplay(R"("host": "10.0.0.7", )", "", ""), "addresses of machines"},
          Case{parse_ndisplay, ndisplay(R"("host": "127.0.0.1", "sound": false, "graphicsAdapter": -1, )", "", ""),
               ""},
          Case{parse_ndisplay, ndisplay(R"("renderHeadless": true, )", "", ""),
               "nDisplay node renderHeadless: not imported"},
          Case{parse_ndisplay, ndisplay("", R"("gPUIndex": 2, )", ""), "nDisplay viewport gPUIndex: not imported"},
          Case{parse_ndisplay, ndisplay("", R"("gPUIndex": -1, )", ""), ""},
          Case{parse_ndisplay, ndisplay("", "", R"("lens": 35, )"), "nDisplay camera lens: not imported"},
          Case{parse_ndisplay, ndisplay("", "", R"("stereoOffset": "up", )"),
               "nDisplay camera stereoOffset up: taken as none"},
          Case{parse_ndisplay, ndisplay("", "", "", R"("misc": {"bFollowLocalPlayerCamera": true}, )"),
               "nDisplay misc: not imported"},
          Case{parse_ndisplay_cfg, ndisplay_text(""), ""},
          Case{parse_ndisplay_cfg, ndisplay_text("", "fov=90"), "nDisplay [camera] fov: not imported"},
          Case{parse_ndisplay_cfg, ndisplay_text("[network] cln_conn_tries_amount=10"),
               "nDisplay [network]: not imported"},
          Case{parse_sgct, sgct_text("", "", plane), ""},
          Case{parse_sgct, sgct_text(R"("address": "10.0.0.7", )", "", plane), "addresses of machines"},
          Case{parse_sgct, sgct_text("", R"(, "res": {"x": 4096, "y": 4096})", plane),
               "SGCT resolutions of pictures"},
          Case{parse_sgct, sgct_text("", R"(, "res": {"x": 80, "y": 60})", plane), ""},
          Case{parse_sgct,
               sgct_text("", "", R"({"type": "TextureMappedProjection", "fov": {"hfov": 90, "vfov": 90}})"),
               "SGCT TextureMappedProjection: taken as"},
          Case{parse_sgct,
               sgct_text("", "", R"({"type": "PlanarProjection", "fov": {"hfov": 90, "vfov": 90, "skew": 1}})"),
               "SGCT projection.fov.skew: not imported"},
          Case{parse_pvx,
               "<pvx><EyeSeparation Value='0.06'/><Machine Geometry='8x6' LowerLeft='-1 -1 -1' LowerRight='1 -1 "
               "-1' "
               "UpperLeft='-1 1 -1' UpperRight='1 1.1 -1'/></pvx>",
               "ParaView UpperRight that makes no rectangle"}}) {
        gi::Report report;
        ImportLog const log(report);
        parse(text, "f", log);
        std::size_t named = 0, others = 0;
        for (SkippedPart const& part : log.parts()) {
            bool const is_usual =
                std::ranges::any_of(kUsual, [&](char const* w) { return part.what.starts_with(w); });
            bool const is_it = !lost.empty() && part.what.starts_with(lost);
            named += is_it;
            others += !is_it && !is_usual;
        }
        EXPECT_EQ(named, lost.empty() ? 0u : 1u) << text << "\n" << skipped(log);
        EXPECT_EQ(others, 0u) << text << "\n" << skipped(log);
    }
}

TEST(ImportNDisplay, OlderText)
{
    std::string const text = R"(# a wall
[info] version="23"
[cluster_node] id=node addr=127.0.0.1 window=wnd master=true
[window] id="wnd" viewports="vp,other" fullscreen=false WinX=10 WinY=20 ResX=800 ResY=600
[viewport] id=vp x=0 y=0 width=400 height=600 projection=proj
[viewport] id=other x=400 y=0 width=400 height=600 projection=blend
[projection] id=proj type="simple" screen=floor
[projection] id=blend type="easyblend" file="D:\a b.pol"
[scene_node] id=origin loc="X=0,Y=0,Z=1" rot="P=0,Y=0,R=0"
[screen] id=floor loc="X=0,Y=0,Z=-1" rot="P=-90,Y=0,R=0" size="X=3,Y=2" parent=origin
[camera] id=cam loc="X=0.5,Y=0,Z=1.7" eye_dist=0.06 tracker_id=head tracker_ch=0
[input] id=head type=tracker addr=T@h
[general] swap_sync_policy=2
[nvidia] sync_group=1 sync_barrier=1
)";
    gi::Report report;
    ImportLog const log(report);
    Display const d = parse_ndisplay_cfg(text, "n.cfg", log);
    ASSERT_EQ(d.walls.size(), 1u) << skipped(log);
    // Pitched down by 90 degrees, its up edge is forward: 3 m across (y), 2 m forward (x), at z = 1 - 1 = 0.
    expect_wall(d.walls[0], {-1.5, 0, 1}, {1.5, 0, 1}, {-1.5, 0, -1});
    EXPECT_EQ(d.windows[0].swap_group, 1);
    EXPECT_LT(glm::length(d.users[0].head.translation_m - gi::dvec3{0, 1.7, -0.5}), 1e-12);
    EXPECT_NE(skipped(log).find(
                  "projection policy easyblend: not supported, viewport skipped: only its maker's library reads "
                  "its files, export them as MPCDI (n.cfg:8:1)"),
              std::string::npos);
    EXPECT_NE(skipped(log).find("nDisplay [input]: not imported (n.cfg:12:1)"), std::string::npos);
    auto const message = [&](std::string const& line) {
        return message_of([&] { parse_ndisplay_cfg(line, "n.cfg", report); });
    };
    EXPECT_NE(message("\nscreen").find("n.cfg:2:1: 'screen' is no part of nDisplay"), std::string::npos);
    EXPECT_NE(message("[screen] id=\"x").find("a quote is not closed"), std::string::npos);
    EXPECT_NE(message("[screen] id=x loc=\"X=one\"").find("X is no number"), std::string::npos);
    EXPECT_NE(message("[cluster_node] id=a window=b").find("there is no [window] id=b"), std::string::npos);
    // Its first line distinguishes it from Vrui's.
    auto const file = std::filesystem::temp_directory_path() / "lightwell_ndisplay_test.cfg";
    gi::write_text(file, text);
    ImportLog const again(report);
    EXPECT_EQ(import_display(file, {}, again), parse_ndisplay_cfg(text, file.string(), report));
    EXPECT_EQ(again.parts().size(), log.parts().size());
    std::filesystem::remove(file);
}

} // namespace
} // namespace viewer::test
