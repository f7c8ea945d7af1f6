#include "viewer/experiment/trial_presenter.h"

#include "gi/core/error.h"
#include "study/display/model_file.h"
#include "viewer/experiment/gaze/screen_gaze.h"
#include "viewer/experiment/page.h"
#include "viewer/experiment/screens/hmd_screen.h"
#include "viewer/experiment/screens/refresh.h"
#include "viewer/experiment/screens/window_screen.h"
#include "viewer/experiment/stimuli/ar_source.h"
#include "viewer/experiment/stimuli/live_source.h"
#include "viewer/experiment/stimuli/prepared.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr double kPage_Hz = 30;

std::unique_ptr<GazeSource> open_gaze_of(study::Script const& script, TrialOptions const& options, double now_s,
                                         std::function<Screen&()> const& screen)
{
    std::string const& what = options.gaze.empty() ? script.record.gaze : options.gaze;
    if (what == "openxr") return std::make_unique<ScreenGaze>(screen);
    return what.empty() || what == "none" ? nullptr : open_gaze(what, now_s);
}

std::unique_ptr<Screen> open_screen(StimulusViewer viewer, TrialOptions const& options, gi::Report& report)
{
    if (viewer == StimulusViewer::headset)
        return std::make_unique<HmdScreen>(options.screen, options.headset, report);
    return std::make_unique<WindowScreen>(options.screen, report);
}

} // namespace

TrialPresenter::TrialPresenter(study::Script const& script, TrialOptions const& options, gi::Report& report)
    : script_(script),
      options_(options),
      report_(report),
      viewer_(options.view),
      screen_(open_screen(options.view, options, report)),
      keys_(script),
      markers_(script.record.markers, options.marker_port, {script.id, options.participant, options.session},
               report),
      experimenter_(options.remote, report),
      table_(options.folder, options.stem),
      gaze_(open_gaze_of(script, options, now(), [this]() -> Screen& { return *screen_; }), options.folder,
            options.stem),
      period_s_(1 / script.timing.expected_hz)
{
    experimenter_.status.experiment = script.id;
    experimenter_.status.participant = options.participant;
    experimenter_.status.started_s = now();
    if (double const hz = screen_->refresh_hz(); hz > 0) period_s_ = 1.0 / hz;
    if (model() && model()->luminance && options.view == StimulusViewer::window)
        table_light_ = make_inverse_table(*model()->luminance);
}

TrialPresenter::~TrialPresenter()
{
    if (options_.audio) {
        report_.lose("times that the sound device ran out of samples", std::size_t(options_.audio->underruns()),
                     "raise --audio-latency-ms");
        report_.lose("samples of sounds beyond full scale", options_.audio->clipped(),
                     "sounds overlap: lower their level_db");
    }
    keep_gaze_table();
    try {
        if (script_.record.compress_frames)
            table_.compress();
        else
            table_.flush();
    } catch (gi::InputError const& e) {
        report_.lose("rows of frames and poses that could not be kept", 1, e.what());
    }
}

double TrialPresenter::seconds(Clock::time_point t) const
{
    return std::chrono::duration<double>(t.time_since_epoch()).count();
}

double TrialPresenter::now() const { return seconds(Clock::now()); }

std::vector<std::pair<std::string, std::string>> TrialPresenter::about() const
{
    auto all = options_.about;
    for (auto const& fact : screen_->about()) all.push_back(fact);
    double const hz = screen_->refresh_hz();
    all.emplace_back("refresh_hz", hz > 0 ? fmt::format("{:g}", hz) : "unknown");
    all.emplace_back("display_lag_ms", fmt::format("{:g}", script_.timing.display_lag_ms));
    if (script_.timing.display_lag_uncertainty_ms > 0)
        all.emplace_back("display_lag_uncertainty_ms",
                         fmt::format("{:g}", script_.timing.display_lag_uncertainty_ms));
    if (model())
        for (auto& fact : study::display_model_facts(*model())) all.push_back(std::move(fact));
    for (auto& fact : gaze_.about()) all.push_back(std::move(fact));
    for (auto& fact : markers_.about()) all.push_back(std::move(fact));
    if (options_.audio)
        for (auto& fact : options_.audio->about()) all.push_back(std::move(fact));
    else if (!script_.sounds.empty())
        all.emplace_back("audio_device", "none: the session ran without sound (--audio none)");
    return all;
}

std::function<std::vector<ViewCommand>(gi::Camera const&)> TrialPresenter::on_walls()
{
    if (!screen_->has_own_views()) return {};
    // Visible about one refresh later.
    return [this](gi::Camera const& camera) {
        return screen_->own_views(camera.world_from_camera, now() + period_s_);
    };
}

/// Paces swaps that do not wait for the display at one per refresh.
ScreenSwap TrialPresenter::present(ScreenContent content)
{
    between_frames();
    if (paced_) screen_->wait_until(next_swap_);
    auto const period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_s_));
    // Drawing time counts towards the period; delays are not made up for, and after a pause a new period begins.
    if (auto const now = Clock::now(); now > next_swap_ + period) next_swap_ = now;
    ScreenSwap const swap = screen_->present(content);
    next_swap_ = std::max(next_swap_ + period, Clock::now());
    return swap;
}

void TrialPresenter::see_in(StimulusViewer viewer)
{
    if (viewer == viewer_) return;
    bool const headset = viewer == StimulusViewer::headset;
    if (!headset) instruct("Please take the headset off.", -1);
    screen_.reset(); // only one panel may exist at a time
    screen_ = open_screen(viewer, options_, report_);
    viewer_ = viewer;
    if (double const hz = screen_->refresh_hz(); hz > 0) period_s_ = 1 / hz;
    study::CalibrationDone const kept = calibrate(script_.timing);
    if (should_end()) end_early();
    if (!kept.passed && script_.timing.vsync == study::Vsync::required)
        throw gi::InputError(headset ? "the headset" : "the window", kept.reason,
                             "write vsync: record if onsets need not be exact");
    experimenter_.note(now(), "display",
                       fmt::format("{}, a refresh every {:.3f} ms (sd {:.3f}), onsets {}{}{}",
                                   headset ? "headset" : "window", kept.period_mean_ms, kept.period_sd_ms,
                                   kept.onset_method, kept.passed ? "" : ", not passed: ", kept.reason));
    if (headset) instruct("Please put the headset on. Answer with its triggers; the other button continues.", -1);
}

void TrialPresenter::between_frames()
{
    experimenter_.poll(now());
    if (gaze_.is_open()) gaze_.poll(screen_->gaze_place(), now());
    if (options_.stop != nullptr && options_.stop->requested() && !should_end()) {
        experimenter_.note(now(), "abort", "the program was interrupted");
        experimenter_.abort("interrupted (SIGINT, SIGTERM or SIGHUP)");
    }
}

void TrialPresenter::add_patch(ScreenContent& content, bool white) const
{
    if (!script_.timing.sync_patch) return;
    auto const& patch = *script_.timing.sync_patch;
    using study::Corner;
    bool const left = patch.corner == Corner::bottom_left || patch.corner == Corner::top_left;
    bool const top = patch.corner == Corner::top_left || patch.corner == Corner::top_right;
    glm::ivec2 const px = screen_->size_px();
    content.patch_size_px = {patch.px, patch.px};
    content.patch_corner_px = {left ? 0 : px.x - patch.px, top ? 0 : px.y - patch.px};
    content.patch_is_white = white;
}

/// None = the gaze is unknown: a mask then hides nothing, a window everything.
std::optional<GazeCircle> TrialPresenter::gaze_circle(study::GazeCircleRule const& rule)
{
    gaze_.poll(screen_->gaze_place(), now()); // what has come until this frame
    auto const gaze = gaze_.latest(now());
    bool const is_window = rule.kind == study::GazeFollow::window;
    if (!gaze && !is_window) return {};
    study::ScreenGeometry const& screen = gaze_screen();
    glm::vec2 const middle = 0.5f * glm::vec2(screen_->size_px());
    GazeCircle c{is_window, middle + (gaze ? glm::vec2(gaze->x_px, gaze->y_px) : glm::vec2(-1e5f)),
                 float(0.5 * study::px_of_size(screen, 2 * rule.radius_deg, false)),
                 float(study::px_of_place(screen, rule.edge_deg, false))};
    return c;
}

/// Between trials; the journal alone decides whether a session can continue.
void TrialPresenter::keep_gaze_table()
{
    try {
        gaze_.flush();
    } catch (gi::InputError const& e) {
        report_.lose("times that rows of gaze could not be written", 1, e.what());
    }
}

study::CalibrationDone TrialPresenter::calibrate(study::Timing const& timing)
{
    paced_ = false;
    std::vector<double> swaps;
    std::string method;
    ScreenContent empty;
    constexpr int kFirst = 10; // the first frames build GPU pipelines
    for (int i = 0; i < timing.calibrate.frames + kFirst && !should_end(); ++i) {
        ScreenSwap const swap = present(empty);
        method = swap.method;
        if (i >= kFirst) swaps.push_back(seconds(swap.seen));
    }
    experimenter_.check_aborted(); // too few swaps may be due to an abort
    study::CalibrationDone done = judge_refresh(swaps, screen_->refresh_hz(), timing, method);
    using study::OnsetMethod;
    bool const is_less = (timing.onset == OnsetMethod::oml && method != "oml") ||
                         (timing.onset == OnsetMethod::openxr && method != "openxr_predicted") ||
                         timing.onset == OnsetMethod::wp_presentation;
    if (is_less) {
        done.passed = false;
        done.reason += std::string(done.reason.empty() ? "" : "; ") +
                       "this display does not support the onset method that the script requires";
    }
    // Swaps much faster than the refresh rate do not wait for the display.
    paced_ = done.period_mean_ms < 0.5e3 * period_s_;
    if (!paced_ && done.passed) period_s_ = 1e-3 * done.period_mean_ms;
    return done;
}

bool TrialPresenter::is_confirm(InputEvent const& e) const
{
    return e.meant_for == InputFor::scene && keys_.given(e, {"confirm"}).has_value();
}

void TrialPresenter::keep_pose(double time_s, std::vector<ViewCommand> const& views)
{
    study::Record const& record = script_.record;
    bool const is_due =
        record.poses_by_frame || (record.head_pose_hz > 0 && time_s >= last_pose_s_ + 1 / record.head_pose_hz);
    if (!is_due || views.empty()) return;
    last_pose_s_ = time_s;
    gi::dmat4 const m = views[0].camera.world_from_camera;
    table_.add(PoseRow{time_s, gi::dvec3(m[3]), glm::quat_cast(glm::dmat3(m))});
}

std::string TrialPresenter::confirm_hint(std::string const& what) const
{
    return fmt::format("{}: {}", keys_.input_of("confirm"), what);
}

bool TrialPresenter::page(std::function<void(glm::vec2)> const& text,
                          std::function<bool(InputEvent const&)> const& done, std::function<bool()> const& over)
{
    bool const was_paced = std::exchange(paced_, false);
    screen_->take_input(); // earlier input is not meant for this page
    bool is_done = false;
    while (!is_done && !should_end()) {
        ScreenContent content;
        content.text = text;
        present(content);
        screen_->wait_until(Clock::now() + std::chrono::microseconds(int(1e6 / kPage_Hz)));
        for (InputEvent const& e : screen_->take_input())
            if (!heed_window(e)) is_done |= done(e);
        is_done |= over && over();
    }
    paced_ = was_paced;
    if (!is_done) end_early();
    return is_done;
}

/// Ends the current step on the experimenter's request: a skipped step counts as done, an aborted one does not.
void TrialPresenter::end_early()
{
    experimenter_.check_aborted();
    experimenter_.take_wish();
}

/// Handles events for the program: closing the window or pressing escape twice ends the session.
bool TrialPresenter::heed_window(InputEvent const& e)
{
    constexpr std::chrono::seconds kTwice{2};
    bool const escape = e.kind == InputKind::key && e.action == InputAction::press && e.code == GLFW_KEY_ESCAPE;
    if (!escape && e.kind != InputKind::close) return false;
    bool const twice = escape && e.time - escaped_ < kTwice;
    if (escape) escaped_ = e.time;
    if (!twice && escape) return true;
    experimenter_.note(seconds(e.time), "abort", escape ? "escape was pressed twice" : "the window was closed");
    experimenter_.abort("aborted by the participant");
    return true;
}

study::StepDone TrialPresenter::instruct(std::string const& markdown, int step)
{
    study::StepDone done{step, now(), 0, ""};
    experimenter_.status.doing = "instructions";
    std::vector<PageLine> const lines = parse_page(markdown);
    std::string const footer = confirm_hint("go on");
    bool const read = page([&](glm::vec2 px) { draw_page(px, lines, footer); },
                           [&](InputEvent const& e) { return is_confirm(e); });
    done.end_s = now();
    if (!read) done.reason = "skipped";
    return done;
}

study::StepDone TrialPresenter::rest(std::string const& prompt, double least_s, int step)
{
    study::StepDone done{step, now(), 0, ""};
    experimenter_.status.doing = "break";
    std::vector<PageLine> const lines = parse_page(prompt.empty() ? "Take a break." : prompt);
    double const end = now() + least_s;
    auto const left = [&] { return int(std::ceil(end - now())); };
    bool const rested = page(
        [&](glm::vec2 px) {
            draw_page(px, lines, left() > 0 ? fmt::format("{} s", left()) : confirm_hint("go on"));
        },
        [&](InputEvent const& e) { return now() >= end && is_confirm(e); });
    done.end_s = now();
    if (!rested) done.reason = "skipped";
    return done;
}

StimulusSource& TrialPresenter::source(std::size_t number, study::Stimuli kind, StimulusSettings const& stimulus)
{
    if (stimulus.ar) {
        bool const is_prepared = kind == study::Stimuli::prepared;
        auto& all = is_prepared ? ar_prepared_ : ar_;
        while (all.size() <= number)
            all.push_back(
                std::make_unique<ArSource>(is_prepared ? options_.prepared : "", options_.version, report_));
        return *all[number];
    }
    if (kind == study::Stimuli::prepared) {
        while (prepared_.size() <= number)
            prepared_.push_back(std::make_unique<PreparedSource>(options_.prepared, options_.version));
        return *prepared_[number];
    }
    while (live_.size() <= number)
        live_.push_back(std::make_unique<LiveSource>(
            options_.scenes, options_.threads, clock_, [] { glfwPostEmptyEvent(); }, report_));
    return *live_[number];
}

study::ExperimenterAction TrialPresenter::action()
{
    try {
        table_.flush();
    } catch (gi::InputError const& e) { // only the journal decides whether a session can continue
        report_.lose("times that rows of frames could not be written", 1, e.what());
    }
    between_frames();
    if (experimenter_.is_paused()) {
        experimenter_.status.doing = "paused";
        page(
            [&](glm::vec2 px) {
                draw_page(px, {{PageLine::Kind::text, "A moment, please."}}, "");
            },
            [](InputEvent const&) { return false; }, [&] { return !experimenter_.is_paused(); });
    }
    experimenter_.check_aborted();
    return experimenter_.take_wish();
}

std::vector<study::NoteTaken> TrialPresenter::notes() { return experimenter_.take_notes(); }

} // namespace viewer
