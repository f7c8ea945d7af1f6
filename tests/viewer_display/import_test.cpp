// Configurations of other programs: corners, frames, units, and that nothing is dropped in silence.

#include "tests/viewer_display/display_samples.h"
#include "viewer/displays/import.h"
#include "viewer/displays/views.h"

namespace viewer::test {
namespace {

constexpr char const* kFolder = LIGHTWELL_SOURCE_DIR "/data/displays/import/";

Display imported(std::string const& name, gi::Report& report)
{
    return import_display(kFolder + name, {}, report);
}

void expect_corners(Wall const& wall, WallCorners const& expected)
{
    EXPECT_LT(glm::length(wall.corners.lower_left - expected.lower_left), 1e-9) << wall.name;
    EXPECT_LT(glm::length(wall.corners.lower_right - expected.lower_right), 1e-9) << wall.name;
    EXPECT_LT(glm::length(wall.corners.upper_left - expected.upper_left), 1e-9) << wall.name;
}

TEST(Import, Sgct)
{
    gi::Report report;
    Display const d = imported("cave.json", report);
    ASSERT_EQ(d.walls.size(), 2u);
    expect_corners(d.walls[0], {{-1.5, 0, -1.5}, {1.5, 0, -1.5}, {-1.5, 3, -1.5}});
    expect_corners(d.walls[1], {{-1.5, 0, 1.5}, {1.5, 0, 1.5}, {-1.5, 0, -1.5}});
    // Its viewports count from below: the front wall is the upper half.
    EXPECT_EQ(viewport_px(d.walls[0], d.windows[0]), (PixelRectangle{0, 0, 1600, 800}));
    EXPECT_EQ(viewport_px(d.walls[1], d.windows[0]), (PixelRectangle{0, 800, 1600, 800}));
    EXPECT_EQ(d.walls[0].stereo, StereoMode::side_by_side);
    EXPECT_EQ(d.users[0].head.translation_m, (gi::dvec3{0, 1.7, 0.5}));
    EXPECT_TRUE(report.losses().empty());
}

std::string sgct(std::string const& projection, std::string const& window = "", std::string const& top = "")
{
    return R"({"version": 1, "masteraddress": "localhost", )" + top +
           R"("nodes": [{"address": "a", "port": 1, "windows": [{"size": {"x": 100, "y": 80})" + window +
           R"(, "viewports": [{"projection": )" + projection + "}]}]}]}";
}

TEST(Import, SgctPlanarProjections)
{
    gi::Report report;
    Display const d = parse_sgct(sgct(R"({"type": "PlanarProjection", "distance": 2,
        "fov": {"left": 45, "right": 26.565051177077990, "up": 45, "down": 0},
        "orientation": {"yaw": 90, "pitch": 0, "roll": 0}})"),
                                 "s.json", report);
    // Two metres away, turned to the right: -z becomes +x.
    expect_corners(d.walls[0], {{2, 0, -2}, {2, 0, 1}, {2, 2, -2}});
    EXPECT_EQ(report.losses().size(), 2u); // no user; the machine's address
    Display const e =
        parse_sgct(sgct(R"({"type": "PlanarProjection", "fov": {"hfov": 90, "vfov": 90}})"), "s.json", report);
    expect_corners(e.walls[0], {{-10, -10, -10}, {10, -10, -10}, {-10, 10, -10}});
}

TEST(Import, SgctStereoModesAndWhatIsLost)
{
    std::string const plane = R"({"type": "PlanarProjection", "fov": {"hfov": 90, "vfov": 90}})";
    auto const wall = [&](std::string const& stereo, gi::Report& report) {
        return parse_sgct(sgct(plane, R"(, "stereo": ")" + stereo + "\""), "s.json", report).walls[0];
    };
    gi::Report report;
    EXPECT_EQ(wall("active", report).stereo, StereoMode::quad_buffer);
    EXPECT_TRUE(wall("top_bottom_inverted", report).swap_eyes);
    EXPECT_EQ(wall("vertical_interlaced", report).stereo, StereoMode::rows);
    EXPECT_TRUE(wall("vertical_interlaced", report).swap_eyes); // its rows count from below, ours from above
    EXPECT_FALSE(wall("checkerboard_inverted", report).swap_eyes);
    EXPECT_EQ(wall("anaglyph_amber_blue", report).stereo, StereoMode::off);
    EXPECT_EQ(report.losses().at("SGCT stereo mode 'anaglyph_amber_blue': shown without stereo").count, 1u);

    gi::Report lost;
    Display const d = parse_sgct(
        sgct(
            plane, R"(, "msaa": 4, "stereo": "none")",
            R"("settings": {}, "users": [{"eyeseparation": 6.5, "pos": {"x": 0, "y": 0, "z": 0}, "tracking": {}}], )"),
        "s.json", lost);
    EXPECT_EQ(d.users[0].interpupillary_m, 0.063);
    for (char const* what :
         {"SGCT window.msaa: not imported", "SGCT settings: not imported", "SGCT user.tracking: not imported",
          "implausible interpupillary distances, replaced by 0.063 m"})
        EXPECT_TRUE(lost.losses().contains(what)) << what;
}

TEST(Import, ParaView)
{
    gi::Report report;
    Display const d = imported("cave.pvx", report);
    ASSERT_EQ(d.walls.size(), 2u);
    expect_corners(d.walls[0], {{-1.5, -1.5, 1.5}, {-1.5, -1.5, -1.5}, {-1.5, 1.5, 1.5}});
    expect_corners(d.walls[1], {{-1.5, -1.5, -1.5}, {1.5, -1.5, -1.5}, {-1.5, 1.5, -1.5}});
    EXPECT_EQ(d.walls[1].rank, 1);
    EXPECT_EQ(d.walls[1].stereo, StereoMode::quad_buffer);
    EXPECT_EQ(d.windows[1], (DisplayWindow{"front", 800, 800, 800, 0, -1, false, false}));
    EXPECT_EQ(d.users[0].interpupillary_m, 0.063);
    EXPECT_EQ(report.losses().size(), 1u); // the head
    gi::Report old;
    Display const e =
        parse_pvx(R"(<pvx><Process Type="server"><FullScreen Value="1"/><Machine Environment="DISPLAY=:0"
        LowerLeft="-1 -1 -2" LowerRight=" 1 -1 -2" UpperLeft="-1 1 -2"/></Process></pvx>)",
                  "old.pvx", old);
    expect_corners(e.walls[0], {{-1, -1, -2}, {1, -1, -2}, {-1, 1, -2}});
    EXPECT_TRUE(e.windows[0].fullscreen);
    EXPECT_TRUE(old.losses().contains("ParaView Machine.Environment: not imported"));
    EXPECT_TRUE(old.losses().contains("windows whose size the file does not tell, taken as 1920 x 1080"));
}

TEST(Import, Equalizer)
{
    gi::Report report;
    Display const d = imported("cave.eqc", report);
    ASSERT_EQ(d.walls.size(), 3u);
    expect_corners(d.walls[0], {{-1, -1, 1}, {-1, -1, -1}, {-1, 1, 1}});
    expect_corners(d.walls[2], {{1, -1, -1}, {1, -1, 1}, {1, 1, -1}});
    EXPECT_EQ(d.walls[1].name, "front");
    EXPECT_EQ(viewport_px(d.walls[1], d.windows[0]), (PixelRectangle{400, 0, 400, 400}));
    EXPECT_EQ(d.windows[0], (DisplayWindow{"cave", 1200, 400, 10, 20, -1, false}));
    EXPECT_EQ(d.walls[0].stereo, StereoMode::quad_buffer);
    EXPECT_EQ(d.users[0].interpupillary_m, 0.063);
    EXPECT_TRUE(report.losses().empty());
}

TEST(Import, EqualizerCanvasesProjectionsAndCompounds)
{
    std::string const window = R"(server { connection { hostname "h" } config { latency 1 appNode { pipe { window {
        viewport [ 0 0 200 100 ] channel { name "a" viewport [ 0 0 .5 1 ] } channel { name "b" viewport [ 0.5 0 .5 1 ] } } } } )";
    gi::Report report;
    Display const canvas = parse_equalizer(window + R"(canvas {
        wall { bottom_left [ -2 0 -1 ] bottom_right [ 2 0 -1 ] top_left [ -2 2 -1 ] }
        segment { channel "a" viewport [ 0 0 .5 1 ] } segment { channel "b" viewport [ .5 0 .5 1 ] }
        segment { channel "b" wall { type HMD } } } } })",
                                           "c.eqc", report);
    ASSERT_EQ(canvas.walls.size(), 2u);
    expect_corners(canvas.walls[1], {{0, 0, -1}, {2, 0, -1}, {0, 2, -1}});
    EXPECT_NEAR(canvas.users[0].interpupillary_m, 0.05, 1e-12); // Equalizer's own
    EXPECT_TRUE(report.losses().contains("Equalizer config latency: not imported"));
    EXPECT_TRUE(report.losses().contains("Equalizer walls fixed to a head (HMD) skipped"));

    gi::Report other;
    Display const compound =
        parse_equalizer(window + R"(attributes { eye_base 0.06 } compound { compound { channel "a"
        attributes { stereo_mode ANAGLYPH } projection { origin [ 0 0 0 ] distance 2 fov [ 90 90 ] hpr [ 180 0 0 ] } } } } })",
                        "c.eqc", other);
    ASSERT_EQ(compound.walls.size(), 1u);
    // hpr 0 lies at -z, half a turn behind the eyes.
    expect_corners(compound.walls[0], {{2, -2, 2}, {-2, -2, 2}, {2, 2, 2}});
    EXPECT_EQ(compound.walls[0].stereo, StereoMode::anaglyph_red_cyan);
    EXPECT_EQ(compound.users[0].interpupillary_m, 0.06);
}

TEST(Import, Vrui)
{
    gi::Report report;
    Display const d = imported("cave.cfg", report);
    ASSERT_EQ(d.walls.size(), 3u);
    double const inch = 0.0254; // x stays, y forward becomes -z, z up becomes y
    expect_corners(d.walls[0],
                   {inch * gi::dvec3{-60, 0, 60}, inch * gi::dvec3{-60, 0, -60}, inch * gi::dvec3{-60, 96, 60}});
    expect_corners(d.walls[1],
                   {inch * gi::dvec3{-60, 0, -60}, inch * gi::dvec3{60, 0, -60}, inch * gi::dvec3{-60, 96, -60}});
    expect_corners(d.walls[2],
                   {inch * gi::dvec3{-60, 0, 36}, inch * gi::dvec3{60, 0, 36}, inch * gi::dvec3{-60, 0, -60}});
    EXPECT_EQ(d.walls[2].rank, 1);
    EXPECT_EQ(d.windows[1], (DisplayWindow{"FrontWindow", 1280, 1024, 1280, 0, -1, false}));
    EXPECT_NEAR(d.users[0].interpupillary_m, 2.5 * inch, 1e-12);
    Eyes const eyes = eyes_of(d.users[0], resting_head(d.users[0]));
    EXPECT_LT(glm::length(eyes.left - inch * gi::dvec3{-1.25, 64.75, 25}), 1e-12);
    for (DisplayView const& view : views_of(d, {})) EXPECT_TRUE(view.camera) << view.name;
    EXPECT_TRUE(report.losses().empty());
}

TEST(Import, VruiSectionsUnitsAndRotations)
{
    std::string const text = R"(section Vrui
  section one
    screenNames (S)
  endsection
  section two
    meterScale 2.0
    uiSize 1.0
    forwardDirection (1.0, 0.0, 0.0)
    upDirection (0.0, 1.0, 0.0)
    screenNames (S)
    windowNames (W)
    section S
      origin (2.0, -1.0, -1.0)
      horizontalAxis (0.0, 0.0, 2.0)
      verticalAxis (0.0, 1.0, 0.1)
      width 2.0
      height 2.0
      rotateAxis (0.0, 1.0, 0.0)
      rotateAngle 90.0
    endsection
    section W
      windowType Strange
      screenName S
      viewerName V
    endsection
    section V
      headTracked true
      leftEyePosition (0.0, 0.0, -0.06)
      rightEyePosition (0.0, 0.0, 0.06)
    endsection
  endsection
endsection
)";
    gi::Report report;
    Display const d = parse_vrui(text, "v.cfg", "two", report);
    // Forward x, up y: right is z. Half metres. Turned by 90 degrees about y: (x, y, z) -> (z, y, -x).
    expect_corners(d.walls[0], {{-1, -0.5, 0.5}, {-1, -0.5, -0.5}, {-1, 0.5, 0.5}});
    EXPECT_NEAR(d.users[0].interpupillary_m, 0.06, 1e-12);
    EXPECT_NEAR(d.users[0].head.rotation_deg.y, 0, 1e-9);
    for (char const* what :
         {"Vrui windowType Strange: shown without stereo",
          "windows whose size the file does not tell, taken as 1920 x 1080",
          "Vrui device daemons are not supported trackers: the head rests until a tracker is added",
          "Vrui environments other than the one imported",
          "Vrui settings that are not about walls, windows and viewers: not imported"})
        EXPECT_TRUE(report.losses().contains(what)) << what;
    EXPECT_EQ(
        report.losses().at("Vrui settings that are not about walls, windows and viewers: not imported").first,
        "uiSize, v.cfg:7");
    EXPECT_NE(message_of([&] { parse_vrui(text, "v.cfg", "three", report); }).find("there are: one, two"),
              std::string::npos);
    EXPECT_NE(
        message_of([&] { parse_vrui(text, "v.cfg", "", report); }).find("v.cfg:2:3: environment 'one' names"),
        std::string::npos);
}

TEST(Import, WhatIsBrokenIsRefusedWithItsPlace)
{
    gi::Report report;
    auto const expect = [&](auto const& parse, std::string const& text, char const* part) {
        std::string const message = message_of([&] { parse(text, "f", report); });
        EXPECT_NE(message.find(part), std::string::npos) << text << "\n  says: " << message;
    };
    expect(parse_sgct, "{\"nodes\": [", "f:");
    expect(parse_sgct, "{\"nodes\": []}", "no wall could be imported");
    expect(parse_sgct, "{}", "nodes is missing");
    expect(parse_sgct, sgct(R"({"type": "StrangeProjection"})"),
           "StrangeProjection, which is not shown in a window, skipped (f:1:");
    expect(parse_sgct, sgct(R"({"type": "ProjectionPlane"})"), "f:1:155: lowerleft is missing");
    expect(parse_pvx, "<pvx><Process>", "f:1: this is not XML");
    expect(parse_pvx, "<a/>", "there is no element <pvx>");
    expect(parse_pvx, "<pvx>\n<Process>\n<Machine LowerLeft='1 2' LowerRight='1 0/5 2'/></Process></pvx>",
           "f:3: LowerLeft=\"1 2\" of a Machine is not three numbers");
    expect(parse_pvx,
           "<pvx><Process><Machine LowerLeft='0 0 0' LowerRight='1 0 0' UpperRight='1.5 1 0'/></Process></pvx>",
           "meet at 63.43 degrees");
    expect(parse_pvx, "<pvx><Process><Machine Geometry='big' LowerLeft='0 0 0'/></Process></pvx>",
           "is no place of a window");
    expect(parse_equalizer, "server { config { }", "f:1:8: a brace is not closed");
    expect(parse_equalizer, "}", "f:1:1: a closing brace too many");
    expect(parse_equalizer, "server { config { canvas { segment { channel \"x\" wall {} } } } }",
           "there is no channel 'x'");
    expect(parse_equalizer, "server { config { canvas { wall { bottom_left [ 1 2 ] } } } }",
           "f:1:35: bottom_left has 2 values");
    expect(parse_equalizer, "x \"y", "f:1:3: a quote is not closed");
    auto const vrui = [](std::string const& text, std::string const& name, gi::Report& r) {
        parse_vrui(text, name, "", r);
    };
    expect(vrui, "section Vrui\n", "f:1:1: section 'Vrui' has no end");
    expect(vrui, "section Vrui\nendsection\nendsection", "f:3:1: an endsection too many");
    expect(vrui, "a 1", "there is no section Vrui");
    expect(vrui, "section Vrui\nsection a\nscreenNames (S)\nwindowNames (W)\nendsection\nendsection",
           "f:2:1: environment 'a' names screens, windows or viewers that this file does not have");
    EXPECT_NE(message_of([] { format_of("a.txt"); }).find("no known kind"), std::string::npos);
    EXPECT_NE(message_of([] { format_of("a.ol"); }).find("EasyBlend (its format is not public"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                  import_display(std::string(kFolder) + "cave.pvx", {"x", {}}, report);
              }).find("only configurations of Vrui"),
              std::string::npos);
}

} // namespace
} // namespace viewer::test
