#include "viewer/bench/shown/shown_bench.h"

#include "gi/core/error.h"
#include "gi/core/quantile.h"
#include "gi/filter/oidn.h"
#include "viewer/app/pose_at.h"
#include "viewer/app/presenter.h"
#include "viewer/app/surfaces_scale.h"
#include "viewer/base/arguments.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/shown/head_path.h"
#include "viewer/bench/shown/score.h"
#include "viewer/devices/gl/context.h"
#include "viewer/engine/quality.h"
#include "viewer/offline/load_world.h"
#include "viewer/report/table_file.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <mutex>
#include <numeric>

namespace viewer {
namespace {

constexpr double kApart_m = 0.063, kFov_deg = 60;
constexpr double kStill_s = 6;   ///< that the head holds still after its path, and clips stand
constexpr double kSettles_s = 2; ///< until flicker is measured then
constexpr double kFirst_s = 1; ///< of the path, which is not scored

/// What is counted while the head moves, and between the first change and the last.
struct ShownCounts {
    std::vector<double> gaps_ms, light_ages_ms, drawing_ms, between_ms, flicker;
    double light_scale = 0, surfaces_scale = 0, paths = 0;
    std::size_t shown = 0, rendered = 0;
    std::map<std::string, double> stages_s;
};

/// Root mean square of what changes between two pictures, 0..255.
double change(std::vector<unsigned char> const& a, std::vector<unsigned char> const& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += gi::square(double(a[i]) - double(b[i]));
    return std::sqrt(sum / double(std::max<std::size_t>(1, a.size())));
}

/// Shows a session to a head on its path, as a window does.
class ShownRun {
public:
    ShownRun(ShownOptions const& o, std::vector<PathChange> const& changes, RenderSession& session,
             RecordedScenes const& scenes, Walker& walker, glm::ivec2 size_px, bool in_software,
             gi::StopRequest const& stop)
        : o_(o),
          scenes_(scenes),
          walker_(walker),
          changes_(changes),
          size_px_(size_px),
          stop_(stop),
          in_software_(in_software),
          draws_surfaces_(session.settings().draw_surfaces),
          renderer_(session, clock_, nullptr, hooks())
    {
        settings_.tone = tone_settings(session.settings());
        settings_.fades = true;
        for (int e = 0; e < o.eyes; ++e) panes_.push_back({{e * size_px.x, 0}, size_px, StereoMode::off, e, -1});
        for (int k = 0; k < 2; ++k)
            targets_.emplace_back(TextureTarget::Format::bytes, glm::ivec2(o.eyes * size_px.x, size_px.y));
    }

    void run()
    {
        if (o_.scene.time_s) renderer_.go_to(*o_.scene.time_s);
        renderer_.look(walker_.at(0, 0, 0));
        while (!renderer_.newest()) {
            if (stop_.requested()) throw gi::Interrupted();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        shown_ = renderer_.newest();
        presenter_.take(shown_, panes_);
        prepare();
        {
            std::lock_guard const lock(counting_);
            begun_s_ = clock_.now_s();
            counts_ = {};
            done_s_ = begun_s_;
        }
        double const end_s = walker_.path().seconds() + kStill_s;
        for (double now = 0; now < end_s; now = clock_.now_s() - begun_s_) {
            if (stop_.requested()) throw gi::Interrupted();
            make_changes(now);
            if (now > walker_.path().seconds() && !std::exchange(stands_, true)) renderer_.post({"play", false});
            show(now);
            wait(now);
        }
        renderer_.stop();
    }

    std::vector<SeenMoment> const& seen() const { return seen_; }
    ShownCounts const& counts() const { return counts_; }

    /// From the first change on until the mean of what is shown has made most of its way, ms; NaN: nothing changed.
    double response_ms() const
    {
        constexpr double kMost = 0.9, kLeast = 0.5; // of the way; of 255
        if (means_.size() < 2 || std::abs(means_.back().mean - means_.front().mean) < kLeast)
            return std::numeric_limits<double>::quiet_NaN();
        double const from = means_.front().mean, way = means_.back().mean - from;
        auto const there =
            std::ranges::find_if(means_, [&](ShownMean const& m) { return (m.mean - from) / way >= kMost; });
        return 1e3 * (there->path_s - changes_.front().path_s);
    }

private:
    static constexpr double kResponse_s = 2.5, kSoon_s = 0.5;
    struct ShownMean {
        double path_s, mean;
    };

    /// Makes the changes that are due.
    void make_changes(double now)
    {
        for (; next_change_ < changes_.size() && changes_[next_change_].path_s <= now; ++next_change_)
            renderer_.post(changes_[next_change_].change, [this](std::string const& error) {
                std::lock_guard const lock(counting_);
                if (!error.empty()) refused_ = error;
            });
        std::lock_guard const lock(counting_);
        if (!refused_.empty())
            throw gi::InputError("a change on the path cannot be made", refused_,
                                 "lightwell info lists the lights, materials and objects of a scene");
    }

    /// Of what is shown since the first change, and last before it.
    void note_mean(double now)
    {
        if (changes_.empty() || now > changes_.front().path_s + kResponse_s) return;
        if (now <= changes_.front().path_s) means_.clear();
        std::vector<unsigned char> const picture = on_screen(0);
        means_.push_back({now, std::accumulate(picture.begin(), picture.end(), 0.0) /
                                   double(std::max<std::size_t>(1, picture.size()))});
    }

    /// The head moves, or the scene between the first change and the last.
    bool moves(double path_s) const
    {
        return walker_.path().moves(path_s) ||
               (!changes_.empty() && path_s >= changes_.front().path_s && path_s < changes_.back().path_s);
    }

    LiveRenderer::Hooks hooks()
    {
        LiveRenderer::Hooks hooks;
        hooks.finished = [this](LiveFrame const& f) {
            std::lock_guard const lock(counting_);
            if (!moves(f.begun_s - begun_s_)) return;
            counts_.between_ms.push_back(1e3 * (f.done_s - std::exchange(done_s_, f.done_s)));
            for (auto const& [stage, s] : f.result.stages_s) counts_.stages_s[stage] += s;
            counts_.light_scale += f.budget.scale;
            counts_.paths += f.budget.paths;
            ++counts_.rendered;
        };
        hooks.failed = [](std::string const& why) { fmt::print(stderr, "note: {}\n", why); };
        return hooks;
    }

    /// As a window does before anybody moves.
    void prepare()
    {
        settings_.surfaces_scale = draws_surfaces_ ? scale_.next() : 0;
        do draw(turn_, cameras(shown_->command.views));
        while (presenter_.views().prepares() && !stop_.requested());
    }

    void draw(std::size_t target, std::vector<gi::Camera> const& now)
    {
        presenter_.draw(targets_[target].target(), {0, 0}, panes_, settings_, now);
        glFinish();
    }

    static std::vector<gi::Camera> cameras(std::vector<ViewCommand> const& views)
    {
        std::vector<gi::Camera> all;
        for (ViewCommand const& v : views) all.push_back(v.camera);
        return all;
    }

    Viewpoint look(double now)
    {
        Viewpoint at = walker_.at(now, now - std::exchange(last_s_, now), begun_s_);
        if (presenter_.views().draws_surfaces()) at.drawn_scale = scale_.next();
        renderer_.look(at);
        anticipation_.see(at);
        return at;
    }

    std::vector<unsigned char> on_screen(int eye) const
    {
        Pane const& pane = panes_[std::size_t(eye)];
        return read_bytes(part_of(targets_[turn_].target(), pane.corner_px, pane.size_px));
    }

    void show(double now)
    {
        Viewpoint at = look(now);
        double const seen_s = begun_s_ + now + std::min(1.5 * surfaces_s_, Anticipation::kFarthest_s);
        if (surfaces_s_ > 0) at = anticipation_.at(begun_s_ + now, seen_s);
        auto const newest = renderer_.newest();
        FrameCommand moment = moment_at(*newest, at, seen_s, renderer_.edits_since(*newest));
        if (newest == shown_ && !presenter_.fades() && settings_.moment &&
            look_same(*newest, *settings_.moment, moment))
            return;
        if (newest != shown_) presenter_.take(newest, panes_);
        shown_ = newest;
        note_light(now);
        double const drawing = clock_.now_s();
        settings_.moment = std::move(moment);
        settings_.drive = scenes_.drive;
        settings_.surfaces_scale = draws_surfaces_ ? scale_.next() : 0;
        std::size_t const drawn = 1 - turn_;
        draw(drawn, cameras(at.views));
        double const done = clock_.now_s();
        drew_s_ = done - drawing;
        score_moments(done - begun_s_); // of what is on the screen until now
        bool const in_motion = moves(now);
        if (in_motion) {
            if (shown_s_ > 0) counts_.gaps_ms.push_back(1e3 * (done - shown_s_));
            counts_.light_ages_ms.push_back(1e3 * (done - newest->command.pose_s));
            counts_.drawing_ms.push_back(1e3 * drew_s_);
            counts_.surfaces_scale += settings_.surfaces_scale;
            ++counts_.shown;
        }
        shown_s_ = in_motion ? done : 0;
        turn_ = drawn;
        note_mean(done - begun_s_);
        if (now > walker_.path().seconds() + kSettles_s) {
            std::vector<unsigned char> picture = on_screen(0);
            if (!still_.empty()) counts_.flicker.push_back(change(still_, picture));
            still_ = std::move(picture);
        }
        if (!presenter_.views().drew_surfaces()) return;
        scale_.measured(settings_.surfaces_scale, drew_s_);
        surfaces_s_ = surfaces_s_ > 0 ? surfaces_s_ + 0.2 * (drew_s_ - surfaces_s_) : drew_s_;
    }

    /// The next one that is scored, on the path.
    double moment_s() const
    {
        double const scored_s = walker_.path().seconds() - kFirst_s;
        return kFirst_s + scored_s * (double(seen_.size()) + 0.5) / o_.moments;
    }

    /// Where the light of what is on the screen was found, before a moment is scored.
    void note_light(double now)
    {
        light_.clear();
        if (int(seen_.size()) >= o_.moments || now + kSoon_s < moment_s()) return;
        for (int e = 0; e < o_.eyes; ++e) light_.push_back(presenter_.views().light_sources(e));
    }

    /// What is still shown at a moment is compared with what should be seen then.
    void score_moments(double until)
    {
        double const moment = moment_s();
        if (int(seen_.size()) >= o_.moments || until < moment) return;
        SeenMoment s{
            walker_.at(moment, 0, begun_s_), moment, scene_time_at(*shown_, begun_s_ + moment), {}, light_};
        for (int e = 0; e < o_.eyes; ++e) s.shown.push_back(on_screen(e));
        seen_.push_back(std::move(s));
    }

    /// Until the next picture is due, as the window's loop.
    void wait(double now)
    {
        constexpr double kPresentation_Hz = 60, kDrawings = 5, kLook_s = 0.004;
        double const taken_s =
            presenter_.views().drew_surfaces()
                ? drew_s_ + drawing_pause_s(renderer_.edits_since(*shown_), in_software_, drew_s_)
                : kDrawings * drew_s_;
        double const next_s = now + std::max(1 / kPresentation_Hz, taken_s);
        while (clock_.now_s() - begun_s_ < next_s && renderer_.newest() == shown_) {
            if (double const t = clock_.now_s() - begun_s_; t - last_s_ > kLook_s) look(t);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }

    ShownOptions const& o_;
    RecordedScenes const& scenes_;
    Walker& walker_;
    std::vector<PathChange> const& changes_;
    std::size_t next_change_ = 0;
    bool stands_ = false; ///< after the path
    std::string refused_; ///< why one cannot be made
    std::vector<ShownMean> means_;
    glm::ivec2 size_px_;
    gi::StopRequest const& stop_;
    bool in_software_, draws_surfaces_;
    SessionClock clock_;
    Presenter presenter_{{}};
    PresentSettings settings_;
    SurfacesScale scale_;
    Anticipation anticipation_;
    std::vector<Pane> panes_;
    std::vector<TextureTarget> targets_; ///< two: one is shown while the other is drawn
    std::size_t turn_ = 0;               ///< which of them is shown
    double begun_s_ = 0, last_s_ = 0, shown_s_ = 0, surfaces_s_ = 0, drew_s_ = 0;
    std::shared_ptr<LiveFrame const> shown_;
    std::vector<SeenMoment> seen_;
    std::vector<LightSources> light_; ///< of what is on the screen, shortly before a moment
    std::vector<unsigned char> still_;
    ShownCounts counts_;
    double done_s_ = 0;
    std::mutex counting_;   ///< of what the rendering thread counts
    LiveRenderer renderer_; ///< ends first
};

} // namespace

BenchTable run_shown(ShownOptions const& o, gi::StopRequest const& stop, gi::Report& report)
{
    auto const [width, height] = parse_size(o.size);
    HeadPath path(o.head);
    std::vector<PathChange> const changes = path_changes(o.changes, o.changes_file);
    std::vector<AvatarChoice> const avatars = avatar_choices(o.avatar, kPathEyeHeight_m, {}, {});
    RecordedScenes const scenes = scenes_with(o.scene, avatars, report);
    if (o.moments > 0 && o.truth_filter.starts_with("oidn")) gi::check_oidn(); // before minutes of showing
    check_folder(o.out);
    std::filesystem::create_directories(o.out);
    GlContext const gl = GlContext::surfaceless(report);
    RenderSession session(scenes.load, o.scene.settings.threads, report);
    session.apply({"draw_surfaces", true});
    if (scenes.drive) session.drive_bodies(scenes.drive);
    for (Change const& c : parse_changes(o.settings)) session.apply(c);
    session.apply({"scene", o.scene.scene});
    CameraChoice const choice = camera_choice(o.scene);
    ChosenCamera const chosen = choose_camera(session.world(), choice);
    Walker walker(std::move(path), chosen.camera, choice.fov_deg.value_or(kFov_deg), {width, height},
                  o.eyes == 2 ? kApart_m : 0,
                  scenes.avatars.empty() ? std::nullopt : std::optional(scenes.avatars[0].stance));
    gi::dvec3 const origin = session.world().origin;
    ShownRun run(o, changes, session, scenes, walker, {width, height}, gl.is_software(), stop);
    run.run();
    ShownErrors const errors = score(o, changes, scenes, run.seen(), origin, stop);

    ShownCounts const& n = run.counts();
    BenchTable table = start_table("shown", "What is shown while a head moves",
                                   {"scene",       "path",           "size",           "eyes",
                                    "interval_ms", "interval_95_ms", "interval_99_ms", "longest_interval_ms",
                                    "drawing_ms",  "rendering_ms",   "light_age_ms",   "longest_light_age_ms",
                                    "response_ms", "flip",           "most_flip",      "rivalry",
                                    "unlit_share", "unlit_error",    "still_flicker",  "surfaces_scale",
                                    "light_scale", "paths"});
    table.facts = {{"OpenGL", gl.description()},
                   {"settings", fmt::format("{}", fmt::join(o.settings, " "))},
                   {"moments", std::to_string(errors.moments)},
                   {"paths of converged pictures", std::to_string(o.truth_paths)},
                   {"filter of converged pictures", o.truth_filter}};
    for (auto const& [stage, s] : n.stages_s)
        table.facts.emplace_back(stage + " ms",
                                 fmt::format("{:.1f}", 1e3 * s / double(std::max<std::size_t>(1, n.rendered))));
    bool const scored = errors.moments > 0;
    auto const if_any = [](bool any, double value) { return any ? Cell(value) : Cell(); };
    table.add({std::filesystem::path(o.scene.scene).stem().string(),
               std::filesystem::path(o.head).stem().string(),
               o.size,
               double(o.eyes),
               gi::quantile(n.gaps_ms, 0.5),
               gi::quantile(n.gaps_ms, 0.95),
               gi::quantile(n.gaps_ms, 0.99),
               gi::quantile(n.gaps_ms, 1),
               gi::quantile(n.drawing_ms, 0.5),
               gi::quantile(n.between_ms, 0.5),
               gi::quantile(n.light_ages_ms, 0.5),
               gi::quantile(n.light_ages_ms, 1),
               if_any(std::isfinite(run.response_ms()), run.response_ms()),
               if_any(scored, errors.flip),
               if_any(scored, errors.most_flip),
               if_any(scored && o.eyes == 2, errors.rivalry),
               if_any(scored && std::isfinite(errors.unlit_share), errors.unlit_share),
               if_any(scored && std::isfinite(errors.unlit_error), errors.unlit_error),
               if_any(!n.flicker.empty(), gi::quantile(n.flicker, 1)),
               n.surfaces_scale / double(std::max<std::size_t>(1, n.shown)),
               n.light_scale / double(std::max<std::size_t>(1, n.rendered)),
               n.paths / double(std::max<std::size_t>(1, n.rendered))});
    write(table, o.out);
    return table;
}

} // namespace viewer
