#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/load.h"
#include "study/display/model_file.h"
#include "viewer/app/cluster_link.h"
#include "viewer/app/hmd_program.h"
#include "viewer/app/layout.h"
#include "viewer/app/replay.h"
#include "viewer/app/user_avatars.h"
#include "viewer/app/view_program.h"
#include "viewer/base/arguments.h"
#include "viewer/base/choices.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/port_options.h"
#include "viewer/base/report_json.h"
#include "viewer/base/standard_streams.h"
#include "viewer/base/validators.h"
#include "viewer/base/version.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/displays/display_file.h"
#include "viewer/engine/quality.h"
#include "viewer/offline/load_world.h"
#include "viewer/offline/rank_options.h"
#include "viewer/offline/render_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <map>
#include <memory>
#include <set>

namespace viewer {
namespace {

struct ViewArguments {
    RenderOptions scene; ///< scene, camera, sky
    std::vector<std::string> settings, fullscreen;
    std::string size, navigate = "fly", record, frame_log, remote, stats, screenshots, display, display_model,
                      replay, out, video, eye = "window", avatar, avatar_joints;
    RankOptions ranks;
    double fps = 30, eye_height_m = 1.6;
    int paths = 0;
    bool hmd = false, seated = false, no_depths = false, no_insets = false, shown = false, hash_shown = false;
    std::optional<int> remote_port;
    std::string remote_token;
    bool remote_open = false;
    double time_limit_s = 0;
    bool no_vsync = false;
};

/// The command line of this process, from /proc.
std::string command_line()
{
    std::ifstream in("/proc/self/cmdline", std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    std::replace(text.begin(), text.end(), '\0', ' ');
    if (!text.empty()) text.pop_back();
    return text;
}

NavigationMode parse_navigation(std::string const& name)
{
    for (NavigationMode const m : {NavigationMode::fly, NavigationMode::walk, NavigationMode::orbit})
        if (name == name_of(m)) return m;
    throw gi::InputError("--navigate " + name, "there is no such mode", "choose fly, walk or orbit");
}

/// Avatars of --avatar and of the display; file names in a display file are relative to its folder.
std::vector<AvatarChoice> choices_of(ViewArguments const& a, std::optional<Display> const& display)
{
    return avatar_choices(a.avatar, a.eye_height_m, display, std::filesystem::path(a.display).parent_path(),
                          a.avatar_joints);
}

ViewOptions view_options(ViewArguments const& a, std::string const& command_line, gi::Report& report)
{
    ViewOptions o;
    RenderOptions const& scene = a.scene;
    if (!a.display.empty()) o.display = load_display(a.display, report);
    if (!a.display_model.empty()) {
        o.display_model = study::load_display_model(a.display_model);
        if (!o.display_model->luminance)
            throw gi::InputError("--display-model " + a.display_model, "it has no luminance",
                                 "measure it: lightwell study calibrate --luminance readings.csv");
    }
    std::vector<AvatarChoice> const avatars = choices_of(a, o.display);
    RecordedScenes scenes = scenes_with(scene, avatars, report);
    o.load = std::move(scenes.load);
    o.drive = std::move(scenes.drive);
    o.avatars = scenes.avatars;
    o.eye_height_m = resting_eye_height_m(o.display, a.eye_height_m);
    o.scene = scene.scene;
    CameraChoice const choice = camera_choice(scene);
    o.first_camera = [choice](gi::World const& world) {
        ChosenCamera const chosen = choose_camera(world, choice);
        if (!chosen.note.empty()) say(chosen.note);
        return chosen.camera;
    };
    o.settings = parse_changes(a.settings);
    auto const size = parse_size(a.size.empty() ? "1280x720" : a.size);
    o.size_px = {size.first, size.second};
    o.monitors = a.fullscreen;
    o.swap_interval = a.no_vsync ? 0 : 1;
    o.threads = scene.settings.threads;
    o.navigation = parse_navigation(a.navigate);
    o.screenshots = a.screenshots;
    o.record = a.record;
    o.frame_log = a.frame_log;
    o.hash_shown = a.hash_shown;
    o.header.program = version_text();
    o.header.command_line = command_line;
    o.load_options = {{"environment", scene.environment},
                      {"environment_rotate_deg", scene.environment_rotate_deg},
                      {"environment_scale", scene.environment_scale},
                      {"light", scene.light},
                      {"background", scene.background}};
    put_avatars(o.load_options, avatars);
    o.remote.socket = a.remote;
    o.remote.port = a.remote_port;
    o.remote.token = a.remote_token;
    o.remote.open = a.remote_open;
    o.time_limit_s = a.time_limit_s;
    return o;
}

/// Rank of this process, known before MPI is initialised; -1 if mpirun did not start it.
int rank_of_environment()
{
    char const* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    return rank == nullptr ? -1 : std::atoi(rank);
}

int ranks_of_environment()
{
    char const* const ranks = std::getenv("OMPI_COMM_WORLD_SIZE");
    return ranks == nullptr ? 1 : std::atoi(ranks);
}

/// Throws InputError if windows of the display belong to ranks that were not started.
void check_ranks(Display const& display, int ranks)
{
    std::vector<std::string> windows;
    std::set<int> missing;
    for (Wall const& wall : display.walls) {
        if (wall.rank < ranks || !missing.insert(wall.rank).second) continue;
        for (int const w : windows_of(display, wall.rank))
            windows.push_back("'" + display.windows[std::size_t(w)].name + "'");
    }
    if (missing.empty()) return;
    bool const one = missing.size() == 1;
    throw gi::InputError(fmt::format("window{} {} belong{} to rank{} {}, but there are {} ranks",
                                     windows.size() == 1 ? "" : "s", fmt::join(windows, ", "),
                                     windows.size() == 1 ? "s" : "", one ? "" : "s", fmt::join(missing, ", "),
                                     ranks),
                         "ranks count from 0, and no process would show them",
                         fmt::format("start with mpirun -n {}", *missing.rbegin() + 1));
}

/// Removes the options of outputs that only the leading rank has.
void follow(ViewOptions& o)
{
    if (o.rank <= 0) return;
    o.record.clear();
    o.remote = {};
    if (!o.frame_log.empty()) o.frame_log += fmt::format(".{}", o.rank);
}

/// Statistics of the leader and of every other rank: its losses, or how it ended early.
nlohmann::ordered_json rank_stats(ClusterLink const& link, gi::Report const& report)
{
    nlohmann::ordered_json ranks;
    ranks.push_back({{"rank", 0}, {"losses", to_json(report)["losses"]}});
    for (RankEnd const& end : link.ends()) {
        nlohmann::ordered_json rank{{"rank", end.rank}, {"name", end.name}};
        auto const told = nlohmann::ordered_json::parse(end.farewell, nullptr, false);
        if (told.is_object())
            for (auto const& [key, value] : told.items()) rank[key] = value;
        if (!end.lost.empty()) rank["lost"] = end.lost;
        ranks.push_back(std::move(rank));
    }
    return ranks;
}

int finish(ViewArguments const& a, ViewRunSummary const& done, ClusterLink const* link, gi::Report const& report)
{
    nlohmann::ordered_json stats;
    stats["version"] = version_text();
    stats["gl"] = done.gl;
    stats["frames_rendered"] = done.rendered;
    stats["schedule"] = done.schedule;
    stats["exposure"] = done.exposure_ev;
    stats["presented"] = done.presented;
    stats["recorded"] = done.recorded;
    stats["longest_block_ms"] = done.longest_block_ms;
    stats["frames"] = to_json(done.frames);
    stats["trackers"] = done.trackers;
    stats["headset"] = done.headset;
    if (link != nullptr) {
        stats["swap_skew"] = to_text(link->skew());
        stats["ranks"] = rank_stats(*link, report);
    }
    stats["report"] = to_json(report);
    if (!a.stats.empty()) gi::write_text(a.stats, to_text(stats));
    fmt::print("{} frames rendered, {} shown{}\n", done.rendered, done.presented,
               !a.record.empty() ? fmt::format(", {} recorded to {}", done.recorded, a.record) : "");
    if (link != nullptr && link->skew().frames > 0) fmt::print("{}\n", to_text(link->skew()));
    std::fflush(stdout);
    print_losses(report);
    if (link != nullptr && !link->failure().empty()) {
        std::fputs(("lightwell: " + link->failure() + "\n").c_str(), stderr);
        return 1;
    }
    return done.files_whole ? 0 : 1;
}

/// Checks before the start that all results can be written.
void check_results(ViewArguments const& a)
{
    std::string const screenshot = a.screenshots.empty() ? "" : a.screenshots + "lightwell_000000.png";
    check_outputs({a.stats, a.record, a.frame_log, screenshot},
                  {a.scene.scene, a.scene.environment, a.display, a.avatar, a.avatar_joints});
}

HmdOptions headset_of(ViewArguments const& a)
{
    HmdOptions headset;
    headset.space = a.seated ? HmdSpace::local : HmdSpace::stage;
    headset.eye_height_m = a.eye_height_m;
    headset.depths = a.no_depths ? HmdDepths::off : HmdDepths::on;
    headset.insets = a.no_insets ? HmdInsets::off : HmdInsets::on;
    return headset;
}

int run(ViewArguments const& a, std::string const& command_line)
{
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    ViewOptions o = view_options(a, command_line, report);
    o.rank = Cluster::started_by_mpirun() ? rank_of_environment() : -1;
    follow(o);
    if (o.rank >= 0 && o.display) {
        try {
            check_ranks(*o.display, ranks_of_environment());
        } catch (gi::InputError const&) {
            if (o.rank == 0) throw;
            return 0; // otherwise mpirun may end the leader before it has printed the message
        }
    }
    if (o.rank < 0) check_results(a);
    if (a.hmd) return finish(a, run_hmd(o, headset_of(a), stop, report), nullptr, report);
    if (o.rank < 0) return finish(a, run_view(o, nullptr, stop, report), nullptr, report);
    if (!o.display)
        throw gi::InputError("view by several ranks without --display", "no walls are assigned to the ranks",
                             "add --display FILE.yaml whose walls have ranks");
    std::string what = o.scene + " on " + a.display;
    std::uint64_t hash = file_hash(o.scene) ^ file_hash(a.display);
    for (AvatarChoice const& avatar : choices_of(a, o.display)) {
        what += " with " + avatar.file;
        hash ^= file_hash(avatar.file) * (2 * avatar.user + 1); // so that equal files do not cancel out
        if (!avatar.joints.empty()) hash ^= file_hash(avatar.joints) * (2 * avatar.user + 3);
    }
    ClusterLink link({version_text(), what, hash}, cluster_settings(a.ranks), [&report] {
        nlohmann::ordered_json const all = to_json(report);
        return nlohmann::ordered_json{{"losses", all["losses"]}, {"peak_memory_bytes", all["peak_memory_bytes"]}}
            .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    });
    if (o.rank == 0) check_results(a); // from here on the others are notified if the leader exits
    ViewRunSummary const done = run_view(o, &link, stop, report);
    if (o.rank == 0) return finish(a, done, &link, report);
    print_losses(report, fmt::format("rank {}: ", o.rank));
    if (!link.failure().empty()) std::fputs(("lightwell: " + link.failure() + "\n").c_str(), stderr);
    return link.failure().empty() && done.files_whole ? 0 : 1;
}

int run_replay(ViewArguments const& a)
{
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    ReplayOptions o;
    o.file = a.replay;
    o.settings = parse_changes(a.settings);
    o.paths = a.paths;
    if (!a.size.empty()) {
        auto const size = parse_size(a.size);
        o.size = {size.first, size.second};
    }
    o.eyes = parse_replayed_eyes(a.eye);
    o.out = a.out;
    o.video = a.video;
    o.fps = a.fps;
    o.shown = a.shown;
    o.threads = a.scene.settings.threads;
    ReplaySummary const done = replay(
        o,
        [&report](nlohmann::json const& load) {
            RenderOptions options;
            try {
                options.environment = load.value("environment", "");
                options.environment_rotate_deg = load.value("environment_rotate_deg", 0.0);
                options.environment_scale = load.value("environment_scale", 1.0);
                options.light = load.value("light", "white"); // of versions that had no other
                options.background = load.value("background", "");
            } catch (nlohmann::json::exception const& e) {
                throw gi::InputError("the recording's scene options cannot be read", e.what(),
                                     "record the walk again");
            }
            return scenes_with(options, avatars_of(load), report);
        },
        stop, report);
    fmt::print("{} frames replayed", done.frames);
    if (as_recorded(o))
        fmt::print(": {} as recorded bit by bit, {} not, {} unknown", done.same, done.other, done.unknown);
    fmt::print("\n");
    if (!done.changed_files.empty())
        fmt::print("the scene has changed since the recording: {} of its files\n", done.changed_files.size());
    if (done.first_other) fmt::print("first different frame: {}\n", *done.first_other);
    if (o.shown)
        fmt::print("{} shown pictures drawn again: {} as recorded bit by bit, {} not, {} unknown\n", done.shown,
                   done.shown_same, done.shown_other, done.shown - done.shown_same - done.shown_other);
    if (done.first_shown_other) fmt::print("first different shown picture: {}\n", *done.first_shown_other);
    if (done.other + done.shown_other > 0 && done.program != version_text())
        fmt::print("recorded by {}; this is {}\n", done.program, version_text());
    std::string const loss = describe_loss(done.end);
    if (!loss.empty()) say(loss);
    std::fflush(stdout);
    print_losses(report);
    return done.interrupted ? interrupted_code() : done.other + done.shown_other > 0 ? 1 : 0;
}

/// Throws for settings that decide nothing in a replay: the recording has what they decided.
void check_replayed_setting(ViewArguments const& a, std::string const& text)
{
    static std::map<std::string, std::string> const without_effect{
        {"paths", "give --paths N"},
        {"scale", "give --size WxH"},
        {"auto_exposure", "set exposure"},
        {"eye_distance", "leave it out, or record with it"},
        {"speed", "leave it out; --fps is the rate of a video"},
        {"play", "leave it out"},
        {"predict", "leave it out"},
        {"reproject", "leave it out"},
        {"refine", "leave it out"},
        {"rate", "leave it out"},
        {"panel", "leave it out"},
        {"font_scale", "leave it out"}};
    std::string const key = current_key(parse_change(text).key);
    if (auto const found = without_effect.find(key); found != without_effect.end())
        throw gi::InputError("--set " + text + " with --replay",
                             "it would have no effect: cameras, times and sizes "
                             "are those of the recording",
                             found->second);
    if ((key == "stereo" || key == "swap_eyes") && a.eye != "window")
        throw gi::InputError("--set " + text + " with --eye " + a.eye, "it would have no effect",
                             "leave one out: it is of the picture of the window");
}

/// Throws if an option is given that has no effect in the chosen mode.
void check_mode(CLI::App const& command, ViewArguments const& a)
{
    bool const replays = !a.replay.empty();
    auto const refuse = [&](std::initializer_list<char const*> names, std::string const& when) {
        for (char const* name : names)
            if (command.get_option(name)->count() > 0)
                throw gi::InputError(std::string(name) + " " + when, "it would have no effect", "leave it out");
    };
    if (replays)
        refuse({"scene",          "--record",      "--frame-log", "--remote",        "--remote-port",
                "--remote-token", "--remote-open", "--display",   "--display-model", "--hmd",
                "--fullscreen",   "--time-limit",  "--navigate",  "--screenshots",   "--stats",
                "--camera",       "--envmap",      "--avatar",    "--avatar-joints", "--eye-height",
                "--hash-shown"},
               "with --replay");
    else
        refuse({"--out", "--video", "--paths", "--fps", "--shown", "--eye"}, "without --replay");
    if (replays && a.out.empty() && a.video.empty()) refuse({"--eye"}, "without --out or --video");
    if (replays)
        for (std::string const& s : a.settings) check_replayed_setting(a, s);
    if (a.record.empty()) refuse({"--hash-shown"}, "without --record");
    if (!a.hmd) refuse({"--seated", "--no-depths", "--no-insets"}, "without --hmd");
    if (a.hmd) refuse({"--size", "--fullscreen", "--no-vsync"}, "with --hmd");
    if (!a.fullscreen.empty()) refuse({"--size"}, "with --fullscreen");
    if (!a.display.empty()) {
        refuse({"--size", "--fullscreen"}, "with --display");
        for (std::string const& s : a.settings)
            if (parse_change(s).key == "stereo")
                throw gi::InputError("--set " + s + " with --display", "it would have no effect",
                                     "set the stereo mode of each wall in the display file");
    }
    if (!replays && a.scene.scene.empty())
        throw gi::InputError("nothing to view", "neither a scene nor --replay is given", "lightwell view atrium");
    if (!a.display_model.empty() && (a.hmd || !a.display.empty()))
        throw gi::InputError("--display-model with --hmd or --display", "it is of the monitor of a desktop window",
                             "leave one out");
    if (a.hmd && !a.display.empty())
        throw gi::InputError("--hmd with --display", "a headset has its own displays", "leave out one of them");
}

} // namespace

void add_view(CLI::App& app, int& exit_code)
{
    auto const a = std::make_shared<ViewArguments>();
    CLI::App* const c = app.add_subcommand("view", about("view"));
    offer(c->add_option("scene", a->scene.scene, "scene file or name of a generated scene, as for render"),
          gi::built_in_scenes());
    declare_view_options(*c, a->scene);
    c->add_option(
         "--set", a->settings,
         "KEY=VALUE, set before the first frame, e.g. quality=exact or stereo=anaglyph-dubois; repeatable")
        ->take_all();
    for (char const* const key : {"method", "device"}) // after --set, which replaces what is there
        c->add_option_function<std::string>(
            std::string("--") + key,
            [a, key](std::string const& value) { a->settings.push_back(std::string(key) + "=" + value); },
            std::string("as --set ") + key + "=...");
    c->add_option("--size", a->size,
                  "window size, pixels (default: 1280x720); with --replay: size of the pictures");
    c->add_option("--fullscreen", a->fullscreen,
                  "full screen on the monitor with this number or name; LEFT,RIGHT for stereo=two-windows")
        ->delimiter(',');
    c->add_flag("--no-vsync", a->no_vsync, "do not wait for the display's refresh");
    c->add_option("--display", a->display, "display file with walls, users and trackers, YAML (docs/displays.md)");
    c->add_option(
        "--display-model", a->display_model,
        "display model of the monitor (study calibrate): pictures are linear in light, by its measured curves");
    c->add_flag("--hmd", a->hmd, "show in the headset of the OpenXR runtime (docs/hmd.md)");
    c->add_option("--avatar", a->avatar,
                  "skinned model, or avatar (built in): follows the first user's head and hands, seen in mirrors");
    c->add_option("--avatar-joints", a->avatar_joints,
                  "joint map of --avatar, YAML (lightwell avatar map proposes one); default: by usual names")
        ->needs("--avatar");
    c->add_flag("--seated", a->seated, "with --hmd: space without a floor; the eyes start at --eye-height");
    c->add_flag("--no-depths", a->no_depths,
                "with --hmd: the runtime gets pictures without depths; some distort transparent things by them");
    c->add_flag("--no-insets", a->no_insets, "with --hmd: no finer pictures of the middle of each eye");
    c->add_option("--eye-height", a->eye_height_m,
                  "m above the floor, when walking, with --avatar or --seated; display files set their users' own")
        ->check(in_range(0.2, 3))
        ->capture_default_str();
    declare_rank_options(*c, a->ranks);
    c->add_option("--navigate", a->navigate, "navigation: fly, walk or orbit")->capture_default_str();
    declare_option(*c, a->scene.settings, "threads");
    c->add_option("--record", a->record, "recording (.lwr) to write, of everything that determines the pixels");
    c->add_flag(
        "--hash-shown", a->hash_shown,
        "with --record: also hashes of what was shown, which makes a GPU wait; --replay --shown compares them");
    c->add_option("--frame-log", a->frame_log, "CSV file with the times of every frame");
    c->add_option("--remote", a->remote, "Unix socket for remote control (docs/remote.md)");
    c->add_option("--remote-port", a->remote_port, "port on 127.0.0.1 for remote control; 0 = any free port");
    declare_port_options(*c, a->remote_token, a->remote_open);
    c->add_option("--replay", a->replay, "render a recording again, off-screen; --set changes settings");
    c->add_flag(
        "--shown", a->shown,
        "with --replay: every picture that was shown, drawn again by OpenGL, in place of every frame rendered");
    c->add_option("--paths", a->paths, "with --replay: paths per pixel and frame; 0 = as recorded")
        ->check(in_range(0, 1 << 20));
    c->add_option("-o,--out", a->out, "with --replay: pictures of the window, e.g. walk_%05d.png or .exr");
    c->add_option("--video", a->video, "with --replay: video of the same pictures, .mkv (FFV1) or .mp4 (H.264)");
    offer(c->add_option(
               "--eye", a->eye,
               "with --replay: pictures as the window showed them in its stereo mode (of walls and headsets: the "
               "first view), of one eye, or of both side by side")
              ->capture_default_str(),
          {"window", "left", "right", "both"});
    c->add_option("--fps", a->fps, "frame rate of --video")->check(in_range(0.01, 1000))->capture_default_str();
    c->add_option("--screenshots", a->screenshots, "prefix of the files of screenshots (F2)");
    c->add_option("--time-limit", a->time_limit_s, "end after this many seconds; 0 = never")
        ->check(in_range(0, 1e9));
    c->add_option("--stats", a->stats, "JSON file with statistics of the whole run");
    c->footer(
        R"(Keys: W A S D Q E move, drag to look around, wheel to approach, click to select,
Ctrl + drag to move the selection, 1..9 0 stereo mode, V split/flicker/difference, C compare with the reference,
M method, + - exposure, Space play/pause, Tab fly/walk/orbit, Z X raise the avatar's hands, P reprojection,
R back to the first camera, O open a scene, T automatic exposure, L headlight, H help, F1 panel, F2 screenshot, F11 swap eyes,
Esc end. All settings: docs/viewer.md.

Exit code 1: the recording or the frame log is not complete, or a rank was lost.
Esc, Ctrl-C and --time-limit close all files and exit with 0; a replay interrupted by Ctrl-C exits with 130.

Examples (they need a display):
  lightwell view atrium
  lightwell view atrium --set stereo=anaglyph-dubois --record walk.lwr --frame-log frames.csv
  lightwell view mirror --avatar avatar --navigate walk
  lightwell view --replay walk.lwr
  lightwell view --replay walk.lwr --set method=reference --paths 256 --video walk.mkv
  mpirun --enable-recovery --bind-to none -n 4 lightwell view atrium --display cave4.yaml)");
    c->callback([a, c, &exit_code] {
        check_mode(*c, *a);
        exit_code = a->replay.empty() ? run(*a, command_line()) : run_replay(*a);
    });
}

} // namespace viewer
