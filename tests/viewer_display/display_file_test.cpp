// Display files: what they say, what they refuse and how, and that they come back as they were.

#include "tests/viewer_display/display_samples.h"
#include "tests/viewer_display/mesh_samples.h"
#include "viewer/displays/check.h"
#include "viewer/displays/display_keys.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

Display parsed(std::string const& text)
{
    gi::Report report;
    return parse_display(text, "d.yaml", report);
}

constexpr char const* kSmall = R"(walls:
  - name: front
    lower_left_m: [-1, 0, -1]
    lower_right_m: [1, 0, -1]
    upper_left_m: [-1, 2, -1]
    window: w
windows:
  - {name: w, size_px: [800, 600]}
users:
  - {name: u, head_position_m: [0, 1.7, 0]}
trackers:
  - {name: t, type: osc, port: 9000, body: /head}
)";

/// The file with `old` replaced.
std::string with(std::string const& old, std::string const& now)
{
    std::string text = kSmall;
    auto const at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), now);
}

TEST(DisplayFile, SaysWhatItSays)
{
    Display const d = parsed(kSmall);
    ASSERT_EQ(d.walls.size(), 1u);
    EXPECT_EQ(d.walls[0].corners, (WallCorners{{-1, 0, -1}, {1, 0, -1}, {-1, 2, -1}}));
    EXPECT_EQ(d.walls[0].viewport, Viewport{});
    EXPECT_EQ(d.walls[0].stereo, StereoMode::off);
    EXPECT_EQ(d.walls[0].user, 0);
    EXPECT_EQ(d.windows[0], (DisplayWindow{"w", 800, 600, 0, 0, -1, false}));
    EXPECT_EQ(d.users[0].interpupillary_m, 0.063);
    EXPECT_EQ(d.trackers[0].address, "127.0.0.1");
    Display const c = shipped("cave5.yaml");
    EXPECT_EQ(c.trackers[0].room_from_tracker, (Placement{{-1.5, 0, 1.5}, {-90, 0, 0}}));
    EXPECT_EQ(c.trackers[1].body, "flystick0");
    EXPECT_EQ(c.trackers[1].wand, WandSettings{});
    EXPECT_EQ(c.users[0].tracker, 0);
    EXPECT_EQ(d.users[0].avatar, "");
    EXPECT_FALSE(d.users[0].eye_height_m);
    User const tall = parsed(with("name: u,", "name: u, avatar: avatar, eye_height_m: 1.85,")).users[0];
    EXPECT_EQ(tall.avatar, "avatar");
    EXPECT_EQ(tall.eye_height_m, 1.85);
    EXPECT_EQ(parsed(with("body: /head", "body: /head, left_foot_body: /l")).trackers[0].left_foot_body, "/l");
}

struct Refusal {
    char const *old, *now, *message;
};

TEST(DisplayFile, EveryRefusalHasItsPlaceAndItsWords)
{
    Refusal const refusals[] = {
        {"walls:", "wals:",
         "d.yaml:1:1: unknown key 'wals' in display (it would be ignored) did you mean 'walls'?"},
        {"    window: w\n", "    window: v\n",
         "d.yaml:6:13: 'v' is not in windows (no entry has this name) there are: w"},
        {"    window: w\n", "", "d.yaml:2:5: window is missing"},
        {"[-1, 0, -1]", "[-1, 0]", "d.yaml:3:19: display.walls[0].lower_left_m is not three numbers"},
        {"[-1, 0, -1]", "[-1, .nan, -1]", "d.yaml:3:24: display.walls[0].lower_left_m[1] is not a number"},
        {"[1, 0, -1]", "[-1, 0, -1]", "d.yaml:3:19: wall 'front': the corners span no area"},
        {"[1, 0, -1]", "[1, 0.5, -1]",
         "d.yaml:3:19: wall 'front': the edges meet at 75.96 degrees (a wall is a rectangle"},
        {"    window: w", "    window: w\n    stereo: 3d",
         "d.yaml:7:13: '3d' is no stereo mode (the name is unknown) there are: off, "
         "side-by-side"},
        {"    window: w", "    window: w\n    stereo: two-windows",
         "d.yaml:7:13: two-windows without a second_window"},
        {"    window: w", "    window: w\n    second_window: w", "a second_window without two-windows"},
        {"    window: w", "    window: w\n    second_window: w\n    stereo: two-windows",
         "d.yaml:7:20: the right eye has no window of its own"},
        {"    window: w", "    window: w\n    viewport_px: [0, 0, 801, 600]",
         "d.yaml:7:18: the viewport reaches to pixel (801, 600) of window 'w', which has 800 x 600"},
        {"    window: w", "    window: w\n    viewport_px: [0, 0, 0.2, 600]", "the viewport has no pixels"},
        {"    window: w", "    window: w\n    viewport_px: [-1, 0, 10, 10]",
         "the viewport is not within the window"},
        {"    window: w", "    window: w\n    viewport_px: [0, 0, 10]", "d.yaml:7:18: 3 numbers, not 4"},
        {"    window: w", "    window: w\n    viewport_px: [0, 0, 9, 9]\n    viewport_fraction: [0, 0, 1, 1]",
         "a viewport in pixels and one in fractions"},
        {"    window: w", "    window: w\n    viewport_px: [0, 0, 9, 8]\n    stereo: side-by-side",
         "9 x 8 pixels cannot be halved (side-by-side gives each eye one half)"},
        {"    window: w", "    window: w\n    render_px: [9]", "d.yaml:7:16: not two numbers"},
        {"    window: w", "    window: w\n    blend: {left_m: -1}", "d.yaml:7:12: a band of blending is negative"},
        {"    window: w", "    window: w\n    blend: {left_m: 1.5, right_m: 1}",
         "the bands of blending overlap each other (the wall is 2 x 2 m)"},
        {"    window: w", "    window: w\n    blend: {gamma: 0.4}", "a gamma of 0.4"},
        {"    window: w", "    window: w\n    blend: {power: 0}", "a power of 0"},
        {"    window: w", "    window: w\n    gain: 5", "a gain of 5"},
        {"    window: w",
         "    window: w\n    warp: {columns: 2, rows: 2, nodes: [[0,0,0,0],[1,0,1,0],[1,1,0,1],[0,1,1,1]]}",
         "d.yaml:7:11: the mesh folds"},
        {"    window: w", "    window: w\n    warp: {columns: 2, rows: 2, nodes: [[0,0,0,0]]}",
         "2 columns and 2 rows need 4 nodes, there are 1"},
        {"    window: w", "    window: w\n    warp: {file: a.yaml, rows: 2}", "warp has both a file and a mesh"},
        {"    window: w", "    window: w\n    warp: {file: not-there.yaml}", "not-there.yaml"},
        {"    window: w", "    window: w\n    user: me", "d.yaml:7:11: 'me' is not in users"},
        {"name: u,", "name: u, avatar: [1],", "d.yaml:10:23: "},
        {"name: u,", "name: u, avatar: nobody.glb,", "d.yaml:10:23: there is no file 'nobody.glb'"},
        {"name: u,", "name: u, avatar: {joints: j.yaml},", "d.yaml:10:23: file is missing"},
        {"name: u,", "name: u, avatar: {file: avatar, joints: nowhere.yaml},",
         "d.yaml:10:46: there is no file 'nowhere.yaml'"},
        {"name: u,", "name: u, avatar: {file: avatar, bones: x},", "bones"},
        {"name: u,", "name: u, eye_height_m: tall,", "d.yaml:10:29: "},
        {"name: u,", "name: u, eye_height_m: 165,", "d.yaml:10:29: eyes 165 m above the floor"},
        {"body: /head", "body: /head, left_foot_body: /head", "d.yaml:12:67: body '/head' twice"},
        {"type: osc, port: 9000, body: /head", "type: fake, right_hand_body: 1", "a body for type: fake"},
        {"    window: w", "    window: w\n    rank: -1", "d.yaml:7:11: display.walls[0].rank is -1"},
        {"    window: w", "    window: w\n    swap_eyes: yes", "neither true nor false"},
        {"size_px: [800, 600]", "size_px: [0, 600]", "d.yaml:8:24: a window of 0 x 600"},
        {"size_px: [800, 600]", "size_px: [800]", "not two numbers"},
        {"size_px: [800, 600]", "size_px: [800, 600], position_px: [2000000, 0]", "a million pixels away"},
        {"{name: w, size_px: [800, 600]}", "{name: w, size_px: [800, 600]}\n  - {name: w, size_px: [800, 600]}",
         "d.yaml:9:12: 'w' is used twice"},
        {"head_position_m: [0, 1.7, 0]", "head_position_m: [0, 1.7, 0], interpupillary_m: 63",
         "d.yaml:10:63: eyes 63 m apart (people's are 0.04 to 0.08 m apart) metres? 63 millimetres are 0.063 m"},
        {"head_position_m: [0, 1.7, 0]", "head_position_m: [0, 1.7, 0], interpupillary_m: 6.3",
         "metres? 6.3 centimetres are 0.063 m"},
        {"head_position_m: [0, 1.7, 0]", "head_position_m: [0, 1.7, 0], interpupillary_m: 0", "eyes 0 m apart"},
        {"head_position_m: [0, 1.7, 0]", "head_position_m: [0, 1e8, 0]", "the head's pose is invalid"},
        {"head_position_m: [0, 1.7, 0]", "head_position_m: [0, 1, 0], eye_offset_m: [0, 80, 0]",
         "more than a metre from the tracked point"},
        {"head_position_m: [0, 1.7, 0]", "head_position_m: [0, 1, 0], head_tracker: x", "'x' is not in trackers"},
        {", head_position_m: [0, 1.7, 0]", "", "d.yaml:10:5: head_position_m is missing"},
        {"{name: u, head_position_m: [0, 1.7, 0]}",
         "{name: u, head_position_m: [0, 1.7, 0]}\n  - {name: v, head_position_m: [0, 1, 0]}",
         "d.yaml:2:5: user is missing (there are several)"},
        {"type: osc", "type: vicon", "d.yaml:12:21: 'vicon' is no type of tracker"},
        {"type: osc, port: 9000, body: /head", "type: vrpn, body: 0", "d.yaml:12:5: no device"},
        {"type: osc, port: 9000, body: /head", "type: vrpn, device: Tracker0, body: 0",
         "d.yaml:12:35: 'Tracker0' is no device of VRPN (it is the device's name, @ and its server) device: "
         "Tracker0@localhost"},
        {"type: osc, port: 9000, body: /head", "type: vrpn, device: T@h:99999, body: 0", "is no device of VRPN"},
        {"type: osc, port: 9000, body: /head", "type: vrpn, device: T@h, port: 3883, body: 0",
         "d.yaml:12:46: a port or address of our own with type: vrpn"},
        {"type: osc, port: 9000, body: /head", "type: vrpn, device: T@h, body: head",
         "'head' is no sensor of VRPN"},
        {"body: /head", "body: /head, device: T@h", "a device with type: osc"},
        {"body: /head", "body: /head, wand: {buttons: [jump]}",
         "d.yaml:12:68: 'jump' is nothing that a button of a wand does (the name is unknown) there are: none, "
         "select"},
        {"body: /head", "body: /head, wand: {axes: [--up]}", "'--up' is nothing that an axis of a wand does"},
        {"body: /head", "body: /head, wand: {keys: []}", "keys"},
        {"type: osc, port: 9000, body: /head", "type: fake, wand: {}", "a wand with type: fake"},
        {"port: 9000", "port: 0", "d.yaml:12:32: port 0"},
        {"body: /head}", "body: /head}\n  - {name: wand, type: dtrack, port: 9000, body: 1}",
         "trackers 't' and 'wand' share 127.0.0.1 port 9000 (one speaks OSC, the other DTrack)"},
        {"body: /head", "body: /", "'/' is no body of OSC"},
        {"body: /head", "body: /tracker/head", "'/tracker/head' is no body of OSC"},
        {"type: osc, port: 9000, body: /head", "type: dtrack, port: 5000, body: head",
         "'head' is no body of DTrack"},
        {"type: osc, port: 9000, body: /head", "type: openxr, body: foot", "'foot' is nothing that OpenXR tracks"},
        {"type: osc, port: 9000, body: /head", "type: file", "no file (poses are read from one with type: file"},
        {"body: /head", "body: /head, latency_ms: -3", "a latency of -3 ms"},
        {"body: /head", "body: /head, filter: {type: kalman}", "'kalman' is no filter"},
        {"body: /head", "body: /head, filter: {type: one-euro, min_cutoff_hz: 0}", "the filter is out of range"},
        {"body: /head", "body: /head, room_from_tracker: {translation_m: [1e9, 0, 0]}",
         "the tracker's pose is invalid"},
        {"body: /head", "body: /head, address: ''", "no address"},
    };
    for (Refusal const& r : refusals) {
        std::string const message = message_of([&] { parsed(with(r.old, r.now)); });
        EXPECT_NE(message.find(r.message), std::string::npos) << r.now << "\n  says: " << message;
    }
    EXPECT_NE(message_of([] { parsed("walls: []\nwindows: []\nusers: []"); }).find("the display has no walls"),
              std::string::npos);
    EXPECT_NE(message_of([] { parsed("walls: []"); }).find("windows is missing"), std::string::npos);
}

TEST(DisplayFile, BodiesOfOscMayBeginWithASlash)
{
    Display const with_slash = parsed(kSmall), without = parsed(with("body: /head", "body: head"));
    EXPECT_EQ(with_slash.trackers[0].body, "/head");
    EXPECT_EQ(without.trackers[0].body, "head");
    EXPECT_EQ(body_name(with_slash.trackers[0].body), body_name(without.trackers[0].body));
}

TEST(DisplayFile, HoldsWandsAndDevicesOfVrpn)
{
    Display const d = parsed(with("type: osc, port: 9000, body: /head",
                                  "type: vrpn, device: Wand@art.lab:4000, controls: Buttons, body: 3, "
                                  "wand: {buttons: [menu, none, forward], axes: [-turn_right, up]}"));
    DisplayTracker const& t = d.trackers[0];
    EXPECT_EQ(t.device + "|" + t.controls + "|" + t.body, "Wand@art.lab:4000|Buttons|3");
    EXPECT_EQ(t.wand->buttons, (std::vector{WandAction::menu, WandAction::none, WandAction::forward}));
    EXPECT_EQ(t.wand->axes, (std::vector<WandAxis>{{WandMotion::turn_right, true}, {WandMotion::up, false}}));
    EXPECT_EQ(parsed(to_yaml(d)), d);
    Display const plain =
        parsed(with("type: osc, port: 9000, body: /head", "type: dtrack, port: 5000, body: flystick1, wand: {}"));
    EXPECT_EQ(plain.trackers[0].wand, WandSettings{});
    EXPECT_EQ(parsed(to_yaml(plain)), plain);
}

TEST(DisplayFile, FaultsThatNoReaderLetsThrough)
{
    auto const fault = [](auto const& spoil) {
        Display d = parsed(kSmall);
        spoil(d);
        auto const found = find_fault(d);
        EXPECT_NE(message_of([&] { require_sound(d, "f"); }).find(found ? found->problem : "none"),
                  std::string::npos);
        return found ? found->problem : "";
    };
    EXPECT_EQ(fault([](Display& d) { d.walls.resize(257, d.walls[0]); }), "257 walls");
    EXPECT_EQ(fault([](Display& d) { d.walls[0].name = ""; }), "the name is empty");
    EXPECT_EQ(fault([](Display& d) { d.walls[0].window = 7; }), "wall 'front' has no window");
    EXPECT_EQ(fault([](Display& d) { d.walls[0].user = -1; }), "wall 'front' has no user");
    EXPECT_EQ(fault([](Display& d) { d.walls[0].rank = 5000; }), "rank 5000");
    EXPECT_EQ(fault([](Display& d) { d.walls[0].render_width_px = 5; }), "pictures of 5 x 0");
    EXPECT_EQ(fault([](Display& d) { d.windows[0].monitor = 256; }), "monitor 256");
    EXPECT_EQ(fault([](Display& d) { d.users[0].tracker = 1; }), "there is no such tracker");
    EXPECT_EQ(fault([](Display& d) { d.walls[0].corners.upper_left.y = std::nan(""); }),
              "wall 'front': a corner is not finite or farther than 10,000 km");
    EXPECT_EQ(fault([](Display& d) { d.users[0].interpupillary_m = std::nan(""); }), "eyes nan m apart");
}

TEST(DisplayFile, WallsMayNotDrawOverEachOther)
{
    std::string const second = R"(  - name: side
    lower_left_m: [-1, 0, 1]
    lower_right_m: [-1, 0, -1]
    upper_left_m: [-1, 2, 1]
    window: w
)";
    std::string const at = "windows:";
    EXPECT_NE(
        message_of([&] { parsed(with(at, second + at)); }).find("walls 'front' and 'side' overlap in window 'w'"),
        std::string::npos);
    EXPECT_NE(message_of([&] {
                  parsed(with(at, second + "    rank: 1\n" + at));
              }).find("d.yaml:12:11: window 'w' is on ranks 0 and 1"),
              std::string::npos);
    std::string const halves = with("    window: w", "    window: w\n    viewport_fraction: [0, 0, 0.5, 1]");
    auto const where = halves.find(at);
    EXPECT_EQ(
        parsed(halves.substr(0, where) + second + "    viewport_px: [400, 0, 400, 600]\n" + halves.substr(where))
            .walls.size(),
        2u);
}

TEST(DisplayFile, DoubtsAreCounted)
{
    gi::Report report;
    std::string text =
        with("head_position_m: [0, 1.7, 0]", "head_position_m: [0, 1.7, 0], interpupillary_m: 0.045");
    text.replace(text.find("[-1, 2, -1]"), 11, "[-1.005, 2, -1]");
    text.replace(text.find("size_px: [800, 600]}"), 20, "size_px: [800, 600]}\n  - {name: idle, size_px: [8, 8]}");
    parse_display(text, "d.yaml", report);
    EXPECT_EQ(report.losses().size(), 4u);
    EXPECT_TRUE(report.losses().contains("walls whose pixels are far from square")) << "2 x 2 m by 800 x 600";
    EXPECT_EQ(report.losses().at("windows without a wall, which stay dark").first, "idle");
    EXPECT_TRUE(report.losses().contains("walls not quite rectangular, made rectangular"));
    EXPECT_TRUE(report.losses().contains("unusual interpupillary distances: most people's are 0.050 to 0.075 m"));
    gi::Report blend;
    Display power = shipped("powerwall.yaml");
    power.walls[1].blend.left_m = 0.1;
    parse_display(to_yaml(power), "d.yaml", blend);
    EXPECT_EQ(blend.losses().at("walls whose overlap differs from their blend width").count, 1u);
}

TEST(DisplayFile, DoubtsWhatNobodyBuilds)
{
    auto const doubts = [](std::function<void(Display&)> const& change) {
        Display d = shipped("cave4.yaml");
        change(d);
        gi::Report report;
        parse_display(to_yaml(d), "d.yaml", report);
        std::string all;
        for (auto const& [what, loss] : report.losses())
            all += fmt::format("{} {}: {}\n", loss.count, what, loss.first);
        return all;
    };
    auto const says = [&](std::string const& part, std::function<void(Display&)> const& change) {
        std::string const all = doubts(change);
        EXPECT_NE(all.find(part), std::string::npos) << all;
    };
    EXPECT_EQ(doubts([](Display&) {}), "");
    auto const shift = [](Wall& w, gi::dvec3 by) {
        for (gi::dvec3* const p : {&w.corners.lower_left, &w.corners.lower_right, &w.corners.upper_left}) *p += by;
    };
    says("2 walls that nearly meet", [&](Display& d) { shift(d.walls[0], {-0.05, 0, 0}); });
    says("the right edge of 'left' and the left edge of 'front' are up to 0.05 m apart", [&](Display& d) {
        shift(d.walls[0], {-0.05, 0, 0});
    });
    EXPECT_EQ(doubts([&](Display& d) { shift(d.walls[0], {-0.001, 0, 0}); }), "") << "a tape measure's error";
    says("4 resting heads far from a wall", [](Display& d) { d.users[0].head.translation_m.y = 170; });
    says("4 walls of more than 30 m", [](Display& d) {
        for (Wall& w : d.walls)
            for (gi::dvec3* const p : {&w.corners.lower_left, &w.corners.lower_right, &w.corners.upper_left})
                *p *= 1000.0;
    });
    says("1 walls that the resting head is behind", [](Display& d) {
        WallCorners& c = d.walls[1].corners;
        c = {c.lower_right, c.lower_left, c.lower_right + c.upper_left - c.lower_left};
    });
    says("'left' at (0, 0) and 'front' at (0, 0)", [](Display& d) {
        for (Wall& w : d.walls) w.rank = 0;
        d.windows[1].x_px = 0;
    });
    says("1 walls in one place", [](Display& d) { d.walls[1].corners = d.walls[0].corners; });
    says("1 walls upside down", [](Display& d) {
        WallCorners& c = d.walls[1].corners;
        gi::dvec3 const up = c.upper_left - c.lower_left;
        c = {c.lower_right + up, c.lower_left + up, c.lower_right};
    });
    says("'front', 3 x 3 m by 1024 x 512 pixels", [](Display& d) { d.windows[1].height_px = 512; });
    EXPECT_EQ(doubts([](Display& d) { d.windows[1].x_px = 0; }), "")
        << "each process may have a desktop of its own";
    EXPECT_EQ(doubts([](Display& d) { d = shipped("powerwall.yaml"); }), "") << "blended walls overlap";
}

TEST(DisplayFile, MeshesAreReadBesideTheFile)
{
    fs::path const folder = fs::path(testing::TempDir()) / "lightwell_display_mesh";
    fs::create_directories(folder);
    gi::write_text(folder / "mesh.yaml",
                   "columns: 2\nrows: 2\nnodes: [[0,0,0,0],[1,0.1,1,0],[0,1,0,1],[1,1,1,1]]\n");
    gi::write_text(folder / "d.yaml", with("    window: w", "    window: w\n    warp: {file: mesh.yaml}"));
    gi::Report report;
    Display const d = load_display(folder / "d.yaml", report);
    ASSERT_TRUE(d.walls[0].warp);
    EXPECT_EQ(d.walls[0].warp->nodes[1].place.y, 0.1);
    EXPECT_EQ(parse_display(to_yaml(d), (folder / "again.yaml").string(), report), d);
    gi::write_text(folder / "mesh.yaml",
                   "columns: 2\nrows: 2\nnodes: [[0,0,0,0],[1,0,1,0],[1,1,0,1],[0,1,1,1]]\n");
    EXPECT_NE(message_of([&] { load_display(folder / "d.yaml", report); }).find("mesh.yaml:1:1: the mesh folds"),
              std::string::npos);
    fs::remove_all(folder);
}

/// Whatever is sound.
Display random_display(std::mt19937& random)
{
    auto const below = [&](int n) { return int(random() % unsigned(n)); };
    auto const real = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    auto const vector = [&](double size) {
        return gi::dvec3{real(-size, size), real(-size, size), real(-size, size)};
    };
    auto const name = [&](int i) {
        char const* const odd[] = {"wall", "null", "1", "ä \"quoted\"", "- x: [", "~", "a\nb\t\\", "#"};
        return fmt::format("{}{}", odd[below(8)], i);
    };
    Display d;
    d.name = below(2) ? name(0) : "";
    for (int i = 0, n = below(3); i < n; ++i) {
        DisplayTracker t{name(i), DisplayTrackerType(below(6)), "10.0.0.7",  0, "",
                         "",      {vector(3), vector(180)},     real(0, 99), {}};
        t.port = 1 + below(65535);
        bool const is_vrpn = t.type == DisplayTrackerType::vrpn;
        t.body = t.type == DisplayTrackerType::osc                 ? "/b"
                 : is_vrpn || t.type == DisplayTrackerType::dtrack ? "3"
                                                                   : "head";
        if (is_vrpn) {
            t.port = 0;
            t.address = DisplayTracker{}.address;
            t.device = "Tracker0@10.0.0.7:4000";
            if (below(2)) t.controls = "Button0";
        }
        if (t.type != DisplayTrackerType::openxr && t.type != DisplayTrackerType::fake && below(2))
            t.wand = {{WandAction(below(18)), WandAction(below(18))}, {{WandMotion(below(5)), below(2) == 1}}};
        if (t.type == DisplayTrackerType::file) t.file = "poses.csv";
        t.filter = {FilterType(below(2)), real(0.1, 9), real(0, 9)};
        if (t.type == DisplayTrackerType::osc && below(2)) t.left_foot_body = "/left", t.right_hand_body = "7";
        d.trackers.push_back(t);
    }
    for (int i = 0, n = 1 + below(3); i < n; ++i)
        d.users.push_back({name(i),
                           real(0.05, 0.075),
                           {vector(3), vector(180)},
                           vector(0.1),
                           below(int(d.trackers.size()) + 1) - 1,
                           below(2) ? "avatar" : "",
                           below(2) ? std::optional(real(0.3, 3)) : std::nullopt});
    for (int i = 0, n = 1 + below(4); i < n; ++i) {
        Wall w;
        w.name = name(i);
        w.corners = random_wall(random);
        w.window = int(d.windows.size());
        d.windows.push_back({name(2 * i), 2 * (1 + below(2000)), 2 * (1 + below(2000)), below(99) - 50, below(9),
                             below(3) - 1, below(2) == 0});
        w.stereo = kStereoModes[std::size_t(below(int(kStereoModes.size())))];
        if (w.stereo == StereoMode::two_windows) {
            w.second_window = int(d.windows.size());
            d.windows.push_back(d.windows.back());
            d.windows.back().name = name(2 * i + 1);
        }
        if (below(2)) w.viewport = {LengthUnit::px, 0, 0, 2, 2};
        if (below(2)) w.render_width_px = w.render_height_px = 1 + below(99);
        w.swap_eyes = below(2) == 0;
        if (w.stereo == StereoMode::off && below(2)) w.eye = below(2) ? Eye::left : Eye::right;
        if (below(4) == 0) {
            w.surface.emplace();
            w.surface->type = kSurfaceTypes[std::size_t(below(4))];
            w.surface->place = {vector(3), vector(180)};
            w.surface->radius_m = real(1, 9);
            w.surface->fov_deg = real(90, 270);
            w.surface->azimuths_deg = {real(-180, 0), real(1, 180)};
            w.surface->elevations_deg = {real(-90, 0), real(1, 90)};
            w.surface->heights_m = {real(-3, 0), real(1, 3)};
            if (below(2)) w.surface->circle = {real(0, 1), real(0, 1), real(0.1, 1), real(0.1, 1)};
            w.surface->mirror = {
                vector(0.1), 0.3, {{0, 0, real(1, 2)}, vector(9)}, {-0.5, 0.5, -0.3, real(0.1, 1)}};
            w.corners = {};
        }
        w.user = below(int(d.users.size()));
        if (below(2) && !w.surface)
            w.blend = {real(0, 0.02), real(0, 0.02), real(0, 0.02), real(0, 0.02), real(0.5, 3), real(1, 3)};
        if (below(3) == 0) {
            w.warp = plain_mesh(2 + below(3), 2 + below(3));
            for (WarpNode& node : w.warp->nodes) node.place += glm::dvec2(real(-0.01, 0.01), real(-0.01, 0.01));
            w.warp->nodes[0].weight = real(0, 1);
        }
        if (below(2)) w.gain = {real(0, 4), 1, real(0, 1)};
        w.rank = below(3);
        d.walls.push_back(w);
    }
    for (DisplayWindow& window : d.windows) {
        window.borders = below(2) == 0;
        window.swap_group = below(3);
        window.swap_barrier = window.swap_group > 0 ? below(3) : 0;
    }
    if (below(2)) d.world = RoomPlace{vector(9), real(-180, 180)};
    return d;
}

TEST(DisplayFile, DisplaysComeBackAsTheyWere)
{
    std::mt19937 random(11);
    for (int i = 0; i < 500; ++i) {
        Display const d = random_display(random);
        std::string const text = to_yaml(d);
        ASSERT_EQ(parsed(text), d) << text;
    }
}

TEST(DisplayFile, SchemaAndReaderKnowTheSameKeys)
{
    std::ifstream in(LIGHTWELL_SOURCE_DIR "/data/display.schema.json");
    nlohmann::json const document = nlohmann::json::parse(in);
    std::map<std::string, std::set<std::string>> in_schema;
    for (auto const& [name, definition] : document.at("$defs").items())
        for (auto const& [key, value] : definition.at("properties").items()) in_schema[name].insert(key);
    EXPECT_EQ(in_schema, display_keys());
    std::vector<std::string> modes;
    for (StereoMode const mode : kStereoModes) modes.push_back(name_of(mode));
    EXPECT_EQ(document["$defs"]["wall"]["properties"]["stereo"]["enum"].get<std::vector<std::string>>(), modes);
    for (StereoMode const mode : kStereoModes) EXPECT_EQ(stereo_mode(name_of(mode)), mode);
}

} // namespace
} // namespace viewer::test
