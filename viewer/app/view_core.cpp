#include "viewer/app/view_core.h"

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "viewer/app/frame_hash.h"
#include "viewer/displays/views.h"
#include "viewer/engine/picture_margin.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

namespace viewer {
namespace {

std::string next(std::string const& key, std::string const& now)
{
    for (SettingKey const& k : setting_keys()) {
        if (k.key != key) continue;
        auto const at = std::find(k.words.begin(), k.words.end(), now);
        return at == k.words.end() || at + 1 == k.words.end() ? k.words.front() : *(at + 1);
    }
    return now;
}

} // namespace

ViewOptions with_surfaces(ViewOptions options)
{
    options.settings.insert(options.settings.begin(), {"draw_surfaces", true});
    return options;
}

ViewCore::ViewCore(ViewOptions const& o, gi::Report& r)
    : options(o), display(o.display), report(r), session(o.load, o.threads, r), requests(state, controls, r)
{
    if (o.drive) session.drive_bodies(o.drive);
    for (Change const& c : o.settings) {
        check_offered(session.settings(), c.key);
        session.apply(c);
    }
    state.begin(session.settings());
    state.follows = o.rank > 0;
    state.navigation.set_eye_height(o.eye_height_m);
    state.navigation.set_mode(o.navigation);
    state.load = [this](std::string const& name, std::function<void(std::string const&)> done) {
        load(name, std::move(done));
    };
    if (!o.remote.socket.empty() || o.remote.port) {
        remote_ = std::make_unique<RemoteServer>(
            o.remote, [this](RemoteRequest const& request) { return requests.handle(request); }, r);
        requests.answer_with(remote_.get());
        if (o.remote.port) std::fputs(("note: " + describe_port(*remote_) + "\n").c_str(), stderr);
    }
}

ViewCore::~ViewCore()
{
    if (renderer) renderer->stop();
}

void ViewCore::start_at(gi::Camera const& of_scene)
{
    gi::Camera camera = of_scene;
    if (display && display->world) {
        gi::dvec3 const rest = display->users.empty() ? gi::dvec3{0} : resting_head(display->users[0]).position;
        camera.world_from_camera = world_from_room(*display->world) * glm::translate(gi::dmat4(1), rest);
    }
    state.first_camera = state.camera = camera;
    // Crossing a scene takes seconds, whatever its size.
    double const speed = std::clamp(0.2 * state.facts.radius_m, 0.05, 20.0);
    Navigation const before = state.navigation;
    state.navigation = Navigation(camera.world_from_camera, speed, state.facts.center);
    state.navigation.set_eye_height(before.eye_height_m());
    state.navigation.set_mode(before.mode());
    gi::dvec3 const from(camera.world_from_camera[3]);
    state.screen_distance_m = std::clamp(glm::length(state.facts.center - from), 0.2, 1e4);
}

void ViewCore::load(std::string const& name, std::function<void(std::string const&)> done)
{
    auto const made = std::make_shared<PreparedScene>();
    bool const first = state.facts.scene.empty(), known = first && name == options.scene;
    auto const choose = [this, first, pixels = std::max(1.0, pixels_())](gi::World const& world) {
        try {
            return SceneStart{options.first_camera(world), pixels};
        } catch (gi::InputError const& e) { // it has no camera of the name given for the first one
            if (first || world.cameras.empty()) throw;
            state.inbox.put([this, why = std::string(e.what())] { state.message = why; });
            return SceneStart{world.cameras.front(), pixels};
        }
    };
    loader_.begin(
        name,
        [this, made, name, choose, settings = state.settings()] {
            *made = session.prepare(name, settings, choose);
            if (!options.record.empty()) made->change.files = hashes_of(made->scene->files);
        },
        [this, made, done, known](std::exception_ptr const& failure) {
            if (failure) return state.inbox.put([this, failure, done] { not_loaded(failure, done); });
            renderer->adopt(made, known ? LiveRenderer::SceneKnown::yes : LiveRenderer::SceneKnown::no,
                            [this, done](RenderSession const& s, std::uint64_t number) {
                                state.inbox.put(
                                    [this, done, number, facts = facts_of(s), scene = s.shown_scene()] {
                                        loaded(facts, scene);
                                        resumes_ = number;
                                        if (done) done({});
                                    });
                            });
        });
}

void ViewCore::loaded(SceneFacts const& facts, SceneChange const& scene)
{
    bool const first = state.facts.scene.empty();
    state.facts = facts;
    state.selection.reset();
    if (!first) state.message.clear();
    if (keeps_recent)
        if (std::string const why = state.open_dialog.recent().add(scene.name); !why.empty())
            report.lose("scenes not kept among the recent ones", 1, why);
    auto_exposure_.begin();
    start_at(scene.start->camera);
    state.refresh_ground();
    if (first) make_files(scene);
    if (first) requests.begin();
}

void ViewCore::not_loaded(std::exception_ptr const& failure, std::function<void(std::string const&)> const& done)
{
    std::string why;
    try {
        std::rethrow_exception(failure);
    } catch (gi::Interrupted const&) {
        why = "the scene was not loaded (another was chosen meanwhile)";
    } catch (std::exception const& e) {
        why = e.what();
        if (state.facts.scene.empty()) failure_ = failure; // there is nothing to show
        state.message = why;
    }
    if (done) done(why);
}

void ViewCore::look(Viewpoint viewpoint)
{
    renderer->look(std::move(viewpoint));
    if (std::uint64_t const scene = std::exchange(resumes_, 0)) renderer->resume(scene);
}

/// Puts the progress of loading, and of a frame that builds for long, into the state, which windows show; that of
/// loading also on stderr.
void ViewCore::show_progress()
{
    constexpr double kLongFrame_s = 0.5;
    state.loading = loader_.progress();
    state.building.reset();
    {
        std::lock_guard const lock(frame_step_.mutex);
        double const since_s = state.clock.now_s() - frame_step_.begun_s;
        bool const builds = frame_step_.step.of > 0 || frame_step_.step.what.starts_with("build");
        if (frame_step_.begun_s >= 0 && since_s > kLongFrame_s && builds)
            state.building = LoadProgress{state.facts.scene, frame_step_.step, since_s, 0};
    }
    if (!state.loading) {
        bar_.reset();
        return;
    }
    if (!bar_) bar_ = std::make_unique<gi::ProgressBar>("load " + state.loading->scene);
    bar_->update(state.loading->fraction, text_of(*state.loading));
}

void ViewCore::check_files() const
{
    for (auto const& file : {options.record, options.frame_log})
        if (!file.empty() && std::filesystem::exists(file))
            throw gi::InputError("'" + file.string() + "' exists already", "it would be replaced",
                                 "give another name, or delete it");
}

void ViewCore::make_files(SceneChange const& scene)
{
    if (!options.frame_log.empty())
        log_ = std::make_unique<FrameLog>(options.frame_log,
                                          options.header.program + "\n" + options.header.command_line, report);
    if (options.record.empty()) return;
    RecordingHeader header = options.header;
    header.scene = scene.name;
    header.settings = {{"settings", all_settings(state.settings())},
                       {"load", options.load_options},
                       {"start", to_json(*scene.start)}};
    if (!scene.files.empty()) header.settings["files"] = scene.files;
    for (Change const& c : options.settings)
        if (is_hidden_mask(c.key)) header.settings["settings"][c.key] = c.value;
    recorder_ = std::make_unique<Recorder>(options.record, header, report);
}

void ViewCore::start(FrameLink* link, std::function<double()> pixels, std::function<void()> published,
                     std::function<std::vector<ViewCommand>(FrameCommand const&)> own_views)
{
    check_files();
    pixels_ = std::move(pixels);
    state.is_one_of_ranks = link != nullptr;
    LiveRenderer::Hooks hooks;
    hooks.finished = [this](LiveFrame const& f) {
        ++summary.rendered;
        summary.schedule = f.schedule;
        if (!recorder_) return;
        FrameCommand command = f.command;
        if (!f.ordered.empty()) command.views = f.ordered;
        // A rank of a cluster renders only its own views, a replay renders all walls,
        // so pixel hashes would differ.
        recorder_->append({command, f.ordered.empty() ? std::optional(frame_hash(f.result)) : std::nullopt, {}});
    };
    hooks.at_step = [this](gi::Step const& step) {
        std::lock_guard const lock(frame_step_.mutex);
        frame_step_.step = step;
        if (frame_step_.begun_s < 0) frame_step_.begun_s = state.clock.now_s();
    };
    hooks.published = [this, published = std::move(published)] {
        {
            std::lock_guard const lock(frame_step_.mutex);
            frame_step_.begun_s = -1;
        }
        if (published) published();
    };
    hooks.own_views = std::move(own_views);
    hooks.failed = [this](std::string const& why) {
        report.lose("frames that could not be rendered", 1, why);
        {
            std::lock_guard const lock(frame_step_.mutex);
            frame_step_.begun_s = -1;
        }
        state.inbox.put([this, why] { state.message = why; });
    };
    renderer = std::make_unique<LiveRenderer>(session, state.clock, link, hooks);
    state.renderer = renderer.get();
    load(options.scene, {});
}

bool ViewCore::poll(gi::StopRequest const& stop)
{
    double const now = state.clock.now_s();
    if (last_poll_s_ > 0)
        summary.longest_block_ms = std::max(summary.longest_block_ms, 1e3 * (now - last_poll_s_));
    last_poll_s_ = now;
    watch_files();
    state.inbox.read();
    show_progress();
    requests.step();
    if (remote_) remote_->poll();
    return !state.ends && !failure_ && !stop.requested() && !renderer->stopped() &&
           !(options.time_limit_s > 0 && now > options.time_limit_s);
}

void ViewCore::obey(Command command)
{
    Settings const& s = state.settings();
    switch (command) {
    case Command::close:
        state.ends = true;
        break;
    case Command::panel:
        state.change({"panel", !s.panel});
        break;
    case Command::help:
        state.shows_help = !state.shows_help;
        break;
    case Command::open_scene:
        state.open_dialog.toggle(state.facts.scene);
        break;
    case Command::hold_exposure:
        state.change({"auto_exposure", s.auto_exposure == "on" ? "hold" : "on"});
        break;
    case Command::headlight:
        state.change({"headlight", !s.headlight});
        break;
    case Command::screenshot:
        state.wants_screenshot = state.own_screenshot = true;
        break;
    case Command::swap_eyes:
        state.change({"swap_eyes", !s.swap_eyes});
        break;
    case Command::next_navigation:
        state.navigation.set_mode(NavigationMode((int(state.navigation.mode()) + 1) % 3));
        state.refresh_ground();
        break;
    case Command::first_camera:
        state.navigation.go_to(state.first_camera.world_from_camera);
        break;
    case Command::next_view:
        state.change({"view", next("view", s.view)});
        break;
    case Command::compare:
        state.change({"compare", s.compare.empty() ? "reference" : ""});
        state.change({"view", s.compare.empty() ? "picture" : "split"});
        break;
    case Command::next_method:
        state.change({"method", next("method", s.method)});
        break;
    case Command::brighter:
        state.change({"exposure", std::min(32.0, s.exposure_ev + 0.25)});
        break;
    case Command::darker:
        state.change({"exposure", std::max(-32.0, s.exposure_ev - 0.25)});
        break;
    case Command::play:
        state.change({"play", !s.play});
        break;
    case Command::reproject:
        state.change({"reproject", !s.reproject});
        break;
    case Command::select:
    case Command::drag:
        break;
    }
}

void ViewCore::expose(LiveFrame const& frame)
{
    if (state.settings().auto_exposure != "on") return auto_exposure_.begin();
    auto const ev = auto_exposure_.see(frame.result.views, state.settings().exposure_ev, state.clock.now_s());
    if (ev && *ev != state.settings().exposure_ev) state.expose(*ev);
}

void ViewCore::note_shown(ShownFrame const& shown)
{
    if (!recorder_) return;
    try {
        recorder_->append(shown);
    } catch (gi::InputError const& e) {
        report.lose("shown pictures not recorded", 1, e.what());
    }
}

void ViewCore::log(FrameTimes const& times)
{
    if (times.dropped > 0) report.lose("frames dropped", std::uint64_t(times.dropped));
    frames_.add(times);
    if (log_) log_->append(times);
}

void ViewCore::watch_files()
{
    if (recorder_) report_failure(options.record, recorder_->failure());
    if (log_) report_failure(options.frame_log, log_->failure());
}

void ViewCore::report_failure(std::filesystem::path const& file, std::string const& why)
{
    if (why.empty() || !unwritten_.insert(file).second) return;
    summary.files_whole = false;
    state.message = fmt::format("'{}' cannot be written any further ({}) earlier data is kept; make room and "
                                "start again",
                                file.string(), why);
    std::fputs(("lightwell: " + state.message + "\n").c_str(), stderr);
}

void ViewCore::finish()
{
    summary.exposure_ev = state.settings().exposure_ev;
    bar_.reset();
    loader_.stop();
    renderer->stop();
    saving_.clear(); // waits
    state.inbox.read();
    if (failure_) std::rethrow_exception(failure_);
    if (!recorder_ && !options.record.empty())
        fmt::print(stderr, "note: nothing was recorded: the program ended before a scene was shown\n");
    if (recorder_) {
        recorder_->finish();
        summary.recorded = recorder_->written_frames();
    }
    if (log_) {
        log_->close();
    }
    summary.frames = frames_.summary();
    watch_files();
}

void ViewCore::save_screenshot(Snapshot shown)
{
    std::erase_if(saving_, [](std::future<void> const& f) {
        return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    saving_.push_back(std::async(std::launch::async, [this, shown = std::move(shown), frame = state.frame] {
        std::string const base = fmt::format("{}lightwell_{:06}", options.screenshots, frame->command.frame);
        std::vector<ViewPicture> const& views = frame->result.views;
        std::string told = fmt::format("saved {}.png and .exr{}", base, views.size() > 1 ? " of each view" : "");
        try {
            gi::write_png(base + ".png", shown.size_px.x, shown.size_px.y, shown.bytes);
            for (std::size_t k = 0; k < views.size(); ++k)
                gi::write_exr(k == 0 ? base + ".exr" : fmt::format("{}_{}.exr", base, k),
                              without_margin(views[k].picture, views[k].margin_px), gi::PixelType::single, report);
        } catch (gi::InputError const& e) {
            told = e.what();
        }
        state.inbox.put([this, told] {
            state.message = told;
            fmt::print(stderr, "note: {}\n", told);
        });
    }));
}

} // namespace viewer
