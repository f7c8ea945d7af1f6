#include "gi/base/error.h"
#include "gi/base/file.h"
#include "viewer/arguments.h"
#include "viewer/commands.h"
#include "viewer/interrupt.h"
#include "viewer/load_world.h"
#include "viewer/render_options.h"
#include "viewer/render_picture.h"
#include "viewer/report_json.h"
#include "viewer/show/view_program.h"
#include "viewer/validators.h"
#include "viewer/version.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct ViewArguments {
    RenderOptions scene; ///< scene, camera, sky
    std::vector<std::string> settings;
    std::string size = "1280x720", fullscreen, navigate = "fly", record, frame_log, remote, stats, screenshots;
    std::optional<int> remote_port;
    double time_limit_s = 0;
    bool no_vsync = false;
};

/// "key=value": value as JSON where it is, else a word.
Change parse_change(std::string const& text)
{
    std::size_t const at = text.find('=');
    if (at == std::string::npos)
        throw gi::InputError("--set " + text, "a setting has a key and a value", "write --set exposure=1.5");
    std::string const value = text.substr(at + 1);
    nlohmann::json const parsed = nlohmann::json::parse(value, nullptr, false);
    return {text.substr(0, at), parsed.is_discarded() ? nlohmann::json(value) : parsed};
}

NavigationMode parse_navigation(std::string const& name)
{
    for (NavigationMode const m : {NavigationMode::fly, NavigationMode::walk, NavigationMode::orbit})
        if (name == name_of(m)) return m;
    throw gi::InputError("--navigate " + name, "it is not known here", "choose fly, walk or orbit");
}

ViewOptions view_options(ViewArguments const& a, std::string const& command_line)
{
    ViewOptions o;
    RenderOptions const scene = a.scene;
    o.load = [scene](std::string const& name, gi::Report& report) {
        RenderOptions named = scene;
        named.scene = name;
        return load_lit_scene(named, report);
    };
    o.scene = scene.scene;
    CameraChoice const choice = camera_choice(scene);
    o.first_camera = [choice](gi::World const& world) {
        ChosenCamera const chosen = choose_camera(world, choice);
        if (!chosen.note.empty()) say(chosen.note);
        return chosen.camera;
    };
    for (std::string const& s : a.settings) o.settings.push_back(parse_change(s));
    auto const size = parse_size(a.size);
    o.size_px = {size.first, size.second};
    o.monitor = a.fullscreen;
    o.swap_interval = a.no_vsync ? 0 : 1;
    o.threads = scene.threads;
    o.navigation = parse_navigation(a.navigate);
    o.screenshots = a.screenshots;
    o.record = a.record;
    o.frame_log = a.frame_log;
    o.header.program = version_text();
    o.header.command_line = command_line;
    o.load_options = {{"environment", scene.environment},
                      {"environment_rotate_deg", scene.environment_rotate_deg},
                      {"environment_scale", scene.environment_scale},
                      {"background", scene.background}};
    o.remote.socket = a.remote;
    o.remote.port = a.remote_port;
    o.time_limit_s = a.time_limit_s;
    return o;
}

int run(ViewArguments const& a, std::string const& command_line)
{
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    ViewSummary const done = run_view(view_options(a, command_line), stop, report);
    nlohmann::ordered_json stats;
    stats["version"] = version_text();
    stats["gl"] = done.gl;
    stats["frames_rendered"] = done.rendered;
    stats["presented"] = done.presented;
    stats["recorded"] = done.recorded;
    stats["longest_block_ms"] = done.longest_block_ms;
    stats["frames"] = to_json(done.frames);
    stats["report"] = to_json(report);
    if (!a.stats.empty()) gi::write_text(a.stats, to_text(stats));
    fmt::print("{} frames rendered, {} shown{}\n", done.rendered, done.presented,
               done.recorded > 0 ? fmt::format(", {} recorded to {}", done.recorded, a.record) : "");
    print_losses(report);
    return 0;
}

} // namespace

void add_view(CLI::App& app, int& exit_code)
{
    auto const a = std::make_shared<ViewArguments>();
    CLI::App* const c =
        app.add_subcommand("view", "Walk through a scene: window, stereo, recording, remote control.");
    c->add_option("scene", a->scene.scene, "a file or a generated scene, as of render")->required();
    declare_view_options(*c, a->scene);
    c->add_option("--set", a->settings,
                  "KEY=VALUE before the first frame, e.g. stereo=anaglyph-dubois; repeatable")
        ->take_all();
    c->add_option("--size", a->size, "of the window, pixels")->capture_default_str();
    c->add_option("--fullscreen", a->fullscreen, "on the monitor of this number or name");
    c->add_flag("--no-vsync", a->no_vsync, "swap at once");
    c->add_option("--navigate", a->navigate, "fly, walk or orbit")->capture_default_str();
    c->add_option("--threads", a->scene.threads, "0 = all")->check(in_range(0, 1024));
    c->add_option("--record", a->record, "recording (.lwr) of everything that decides the pixels");
    c->add_option("--frame-log", a->frame_log, "CSV of the times of every frame");
    c->add_option("--remote", a->remote, "Unix socket to be controlled by (docs/remote.md)");
    c->add_option("--remote-port", a->remote_port, "the same on 127.0.0.1; 0 = a free one");
    c->add_option("--screenshots", a->screenshots, "prefix of pictures saved by F2");
    c->add_option("--time-limit", a->time_limit_s, "end after so many seconds; 0 = never")
        ->check(in_range(0, 1e9));
    c->add_option("--stats", a->stats, "JSON about the whole session");
    c->footer(
        R"(Keys: W A S D Q E move, drag looks, wheel nears, click selects, control + drag moves what is selected,
1..9 0 stereo, V split/flicker/difference, C compare with the reference, M method, + - exposure, space plays,
Tab fly/walk/orbit, R first camera, P reprojection, F1 panel, F2 screenshot, F11 swaps eyes, Esc ends.
All settings: docs/viewer.md.

Examples (they need a display):
  lightwell view atrium
  lightwell view atrium --set stereo=anaglyph-dubois --record walk.lwr --frame-log frames.csv)");
    c->callback([a, &app, &exit_code] { exit_code = run(*a, app.config_to_str()); });
}

} // namespace viewer
