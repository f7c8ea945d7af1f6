// What people see while they move: the viewer's rendering thread and its presenter run in real time, driven by a
// recorded head, and what is shown at given moments is compared with converged pictures of those moments.
//   bench_moving_view SCENE HEAD.csv --out DIR [--truth DIR] [--truth-paths N] [--truth-filter NAME] [--size WxH]
//   [--eyes 1|2] [--fov DEG]
//   [--avatar FILE] [--scored N] [--set KEY=VALUE]... [--offline HZ] [--light-scale S] [--surface-scale S]
//   [--late S] [--drawn-scale S] [--paths N] [--young N]
// HEAD.csv: time_s, then the head relative to the scene's first camera: x_m,y_m,z_m (right, up, back), yaw_deg,
// pitch_deg (left, up). --fov is the vertical field of view (60). The truth is that of the method reference at the
// session's bounces, through a filter (oidn-high); it is kept in its folder and reused. With two eyes (0.063 m
// apart), rivalry is the mean difference of the eyes' errors at points that both see. --offline: frames at a fixed
// rate instead of real time, with light and surfaces at fixed scales and --paths (1); with
// --late, shown for the head of S seconds later, its surfaces drawn at --drawn-scale (1) of the size; --young: N frames of a head
// that holds still, scored after 1, 2, 4, ... Writes shown_K_E.png, truth_K_E.png, error_K_E.png (K scored moment,
// E eye) and prints a row of figures.

#include "gi/core/error.h"
#include "tests/bench/moving_view/offline.h"
#include "viewer/app/pose_at.h"
#include "viewer/app/presenter.h"
#include "viewer/app/surfaces_scale.h"
#include "viewer/devices/gl/context.h"
#include "viewer/engine/live/live_renderer.h"
#include "viewer/offline/choose_camera.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <map>
#include <mutex>

namespace {

using namespace viewer;

void run(Options const& o)
{
    fs::create_directories(o.out);
    gi::Report report;
    GlContext const gl = GlContext::surfaceless(report);
    std::vector<AvatarChoice> const avatars = avatar_choices(o.avatar, kEyeHeight_m, {}, {});
    RecordedScenes const scenes = scenes_with({}, avatars, report);
    RenderSession session(scenes.load, 0, report);
    session.apply({"draw_surfaces", true});
    if (scenes.drive) session.drive_bodies(scenes.drive);
    for (Change const& c : o.settings) session.apply(c);
    session.apply({"scene", o.scene});
    gi::Camera const first = choose_camera(session.world(), {}).camera;
    gi::dvec3 const origin = session.world().origin;
    Walk walk(o, first, scenes.avatars.empty() ? std::nullopt : scenes.avatars[0].stance);
    SessionClock const clock;
    std::vector<double> done_s;
    std::map<std::string, double> stages_s;
    double light_scale = 0, surfaces = 0, paths = 0;
    LiveRenderer::Hooks hooks;
    std::mutex counting; // of what the rendering thread counts
    hooks.finished = [&](LiveFrame const& f) {
        std::lock_guard const lock(counting);
        done_s.push_back(f.done_s);
        for (auto const& [stage, s] : f.result.stages_s) stages_s[stage] += s;
        light_scale += f.budget.scale;
        surfaces += f.budget.surfaces;
        paths += f.budget.paths;
    };
    hooks.failed = [](std::string const& why) { fmt::print(stderr, "failed: {}\n", why); };
    std::vector<Seen> seen;
    if (o.offline_hz > 0) {
        render_offline(o, session, walk, seen);
        fmt::print("{} {} {}x{} x{}\n", o.scene, o.young > 0 ? "still" : fs::path(o.head).stem().string(), o.width,
                   o.height, o.eyes);
        for (auto const& [what, n] : report.counts()) fmt::print("  {}: {:.6g}\n", what, n);
        for (auto const& [stage, s] : report.times()) fmt::print("  {}: {:.2f} s\n", stage, s);
        return score(o, scenes, seen, origin);
    }
    int presented = 0;
    // While the head moves: time between what was shown, and since the pose for which it was rendered.
    std::vector<double> shown_gaps_ms, ages_ms;
    double shown_at_s = 0; // 0: the head did not move then
    double draw_s = 0;
    double begun = 0;
    std::size_t first_frame = 0;
    {
        LiveRenderer renderer(session, clock, nullptr, hooks);
        Presenter presenter({});
        PresentSettings settings;
        settings.tone = tone_settings(session.settings());
        bool const draws_surfaces = session.settings().draw_surfaces;
        SurfacesScale surfaces_scale;
        Anticipation anticipation;
        double surfaces_s = 0; ///< that drawing them takes
        std::vector<Pane> panes;
        std::vector<TextureTarget> targets;
        for (int e = 0; e < o.eyes; ++e) {
            panes.push_back({{0, 0}, {o.width, o.height}, StereoMode::off, e, -1});
            for (int k = 0; k < 2; ++k)
                targets.emplace_back(TextureTarget::Format::bytes, glm::ivec2(o.width, o.height));
        }
        std::size_t turn = 0; // of an eye's two targets: one is shown while the other is drawn
        renderer.look(walk.at(0, 0));
        if (!renderer.next_frame(60)) throw gi::InputError("no frame in 60 s", "", "");
        std::shared_ptr<LiveFrame const> shown = renderer.newest();
        presenter.take(shown, panes);
        double const uploads = clock.now_s();
        if (draws_surfaces) { // as a window does before anybody moves
            settings.surfaces_scale = surfaces_scale.next();
            std::vector<gi::Camera> cameras;
            for (ViewCommand const& v : shown->command.views) cameras.push_back(v.camera);
            do
                presenter.draw(targets[0].target(), {0, 0}, {panes[0]}, settings, cameras);
            while (presenter.prepares());
            fmt::print("surfaces can be drawn after {:.2f} s\n", clock.now_s() - uploads);
        }
        begun = clock.now_s();
        walk.begin(begun);
        {
            std::lock_guard const lock(counting);
            first_frame = done_s.size();
            stages_s.clear();
            light_scale = surfaces = paths = 0;
        }
        double last = 0;
        for (int k = 0; k < o.scored;) {
            double const now = clock.now_s() - begun;
            Viewpoint at = walk.at(now, now - last);
            at.draws_surfaces = presenter.draws_surfaces();
            last = now;
            std::vector<gi::Camera> cameras;
            for (ViewCommand const& v : at.views) cameras.push_back(v.camera);
            renderer.look(at);
            anticipation.see(at);
            double const seen_s = begun + now + std::min(1.5 * surfaces_s, Anticipation::kFarthest_s);
            Viewpoint const expected = anticipation.at(begun + now, seen_s);
            if (surfaces_s > 0) {
                cameras.clear();
                for (ViewCommand const& v : expected.views) cameras.push_back(v.camera);
            }
            auto const newest = renderer.newest();
            if (newest != shown) presenter.take(newest, panes);
            shown = newest;
            double const drawing = clock.now_s();
            settings.pose = [&](LiveFrame const& f) { return pose_at(f, expected, scenes.drive, seen_s); };
            settings.surfaces_scale = draws_surfaces ? surfaces_scale.next() : 0;
            for (int e = 0; e < o.eyes; ++e)
                presenter.draw(targets[2 * std::size_t(e) + turn].target(), {0, 0}, {panes[std::size_t(e)]},
                               settings, cameras);
            ++presented;
            glFinish();
            draw_s += clock.now_s() - drawing;
            if (double const s = clock.now_s(); walk.moves(now)) {
                if (shown_at_s > 0) shown_gaps_ms.push_back(1e3 * (s - shown_at_s));
                shown_at_s = s;
                ages_ms.push_back(1e3 * (s - newest->command.pose_s));
            } else {
                shown_at_s = 0;
            }
            read_bytes(part_of(targets[turn].target(), {0, 0}, {1, 1})); // waits as a swap does
            turn = 1 - turn;
            // What is still shown at a moment is compared with what should be seen then. The first second is not scored.
            double const moment = 1 + (walk.seconds() - 1) * (k + 0.5) / o.scored;
            if (clock.now_s() - begun >= moment && presented > 1) {
                Seen s{walk.at(moment, 0), scene_time_at(*newest, begun + moment), {}};
                for (int e = 0; e < o.eyes; ++e)
                    s.shown.push_back(read_bytes(targets[2 * std::size_t(e) + turn].target()));
                seen.push_back(std::move(s));
                ++k;
            }
            double const drew_s = clock.now_s() - drawing;
            if (presenter.drew_surfaces()) {
                surfaces_scale.measured(settings.surfaces_scale, drew_s);
                surfaces_s = surfaces_s > 0 ? surfaces_s + 0.2 * (drew_s - surfaces_s) : drew_s;
            }
            double const next_s = now + std::max(1.0 / 60, presenter.drew_surfaces() ? 0 : 5 * drew_s);
            while (clock.now_s() - begun < next_s) { // as the window's loop does
                double const t = clock.now_s() - begun;
                if (t - last > 0.004) {
                    Viewpoint next = walk.at(t, t - last);
                    next.draws_surfaces = presenter.draws_surfaces();
                    renderer.look(next);
                    anticipation.see(next);
                    last = t;
                }
                if (renderer.newest() != shown) break;
                std::this_thread::sleep_for(std::chrono::milliseconds(2));
            }
        }
    }
    double const took = clock.now_s() - begun;
    std::vector<double> gaps;
    for (std::size_t k = std::max<std::size_t>(1, first_frame); k < done_s.size(); ++k)
        gaps.push_back(1e3 * (done_s[k] - done_s[k - 1]));
    if (gaps.empty()) throw gi::InputError("no two frames while the head moved", "the scene is too slow", "");
    std::ranges::sort(gaps);
    double const frames = double(std::max<std::size_t>(1, gaps.size()));
    fmt::print(
        "{} {} {}x{} x{}: {:.1f} frames/s rendered, {:.1f} shown; ms between frames: median {:.0f}, 95 % {:.0f}, "
        "most {:.0f}; drawn in {:.1f} ms; scale of light {:.3f}, of surfaces {:.3f}, paths {:.1f}\n",
        o.scene, fs::path(o.head).stem().string(), o.width, o.height, o.eyes, frames / took, presented / took,
        gaps[gaps.size() / 2], gaps[gaps.size() * 95 / 100], gaps.back(), 1e3 * draw_s / presented,
        light_scale / frames, surfaces / frames, paths / frames);
    auto const spread = [](std::vector<double> v) {
        if (v.empty()) return std::string("none");
        std::ranges::sort(v);
        return fmt::format("median {:.0f}, 95 % {:.0f}, 99 % {:.0f}, most {:.0f}", v[v.size() / 2],
                           v[v.size() * 95 / 100], v[v.size() * 99 / 100], v.back());
    };
    fmt::print("  while the head moves: ms between shown: {}; age of the pose that the picture was rendered for, "
               "ms: {}\n",
               spread(shown_gaps_ms), spread(ages_ms));
    for (auto const& [stage, s] : stages_s)
        if (1e3 * s / frames >= 0.5) fmt::print("  {}: {:.1f} ms\n", stage, 1e3 * s / frames);
    for (auto const& [loss, entry] : report.losses()) fmt::print("  lost: {}\n", loss);

    score(o, scenes, seen, origin);
}

} // namespace

int main(int argc, char** argv)
try {
    Options o;
    std::vector<std::string> files;
    for (int i = 1; i < argc; ++i) {
        std::string const a = argv[i];
        auto const value = [&] { return std::string(i + 1 < argc ? argv[++i] : ""); };
        if (a == "--out")
            o.out = value();
        else if (a == "--truth")
            o.truth = value();
        else if (a == "--truth-paths")
            o.truth_paths = std::stoi(value());
        else if (a == "--truth-filter")
            o.truth_filter = value();
        else if (a == "--size") {
            if (std::sscanf(value().c_str(), "%dx%d", &o.width, &o.height) != 2) return 2;
        } else if (a == "--eyes")
            o.eyes = std::stoi(value());
        else if (a == "--fov")
            o.fov_deg = std::stod(value());
        else if (a == "--offline")
            o.offline_hz = std::stod(value());
        else if (a == "--paths")
            o.paths = std::stoi(value());
        else if (a == "--young")
            o.young = std::stoi(value());
        else if (a == "--light-scale")
            o.light_scale = std::stod(value());
        else if (a == "--late")
            o.late_s = std::stod(value());
        else if (a == "--drawn-scale")
            o.drawn_scale = std::stod(value());
        else if (a == "--surface-scale")
            o.surface_scale = std::stod(value());
        else if (a == "--avatar")
            o.avatar = value();
        else if (a == "--scored")
            o.scored = std::stoi(value());
        else if (a == "--set")
            o.settings.push_back(parse_change(value()));
        else
            files.push_back(a);
    }
    if (files.size() != 2 || o.out.empty()) {
        fmt::print(stderr, "usage: bench_moving_view SCENE HEAD.csv --out DIR ...\n");
        return 2;
    }
    o.scene = files[0];
    o.head = files[1];
    run(o);
    return 0;
} catch (std::exception const& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
}
