// What people see while they move: the viewer's rendering thread and its presenter run in real time, driven by a
// recorded head, and what they show at given moments is compared with converged pictures of those moments.
//   bench_moving_view SCENE HEAD.csv --out DIR [--truth DIR] [--truth-paths N] [--truth-filter NAME] [--size WxH]
//   [--eyes 1|2] [--fov DEG]
//   [--avatar FILE] [--scored N] [--set KEY=VALUE]... [--offline HZ] [--light-scale S] [--surface-scale S]
//   [--late S] [--paths N] [--young N]
// HEAD.csv: time_s, then the head relative to the scene's first camera: x_m,y_m,z_m (right, up, back), yaw_deg,
// pitch_deg (left, up). --fov is the vertical field of view (60). The truth is that of the method reference at the
// session's bounces, through a filter (oidn-high); it is kept in its folder and reused. With two eyes (0.063 m
// apart), rivalry is the mean difference of the eyes' errors at points that both see. --offline: frames at a fixed
// rate instead of real time, with light and surfaces at fixed scales and --paths (1); with
// --late, reprojected to the head of S seconds later; --young: N frames of a head
// that holds still, scored after 1, 2, 4, ... Writes shown_K_E.png, truth_K_E.png, error_K_E.png (K scored moment,
// E eye) and prints a row of figures.

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "gi/metrics/flip.h"
#include "gi/scene/model/projection.h"
#include "viewer/app/presenter.h"
#include "viewer/app/user_body.h"
#include "viewer/devices/gl/context.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/offline/user_avatars.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numeric>
#include <sstream>

namespace {

using namespace viewer;
namespace fs = std::filesystem;

struct Options {
    std::string scene, head, avatar, truth_filter = "oidn-high";
    fs::path out, truth;
    int truth_paths = 128, width = 640, height = 480, eyes = 1, scored = 8, young = 0, paths = 1;
    double fov_deg = 60, offline_hz = 0, light_scale = 0.25, surface_scale = 1, late_s = 0;
    std::vector<Change> settings;
};

struct HeadSample {
    double time_s = 0;
    std::array<double, 5> pose{}; ///< x, y, z, yaw, pitch
};

std::vector<HeadSample> read_head(std::string const& file)
{
    std::ifstream in(file);
    std::vector<HeadSample> samples;
    std::string line;
    while (std::getline(in, line)) {
        std::ranges::replace(line, ',', ' ');
        std::istringstream words(line);
        HeadSample s;
        if (words >> s.time_s >> s.pose[0] >> s.pose[1] >> s.pose[2] >> s.pose[3] >> s.pose[4])
            samples.push_back(s);
    }
    if (samples.size() < 2) throw gi::InputError("'" + file + "' has no samples", "", "give a recorded head");
    return samples;
}

gi::dmat4 head_at(std::vector<HeadSample> const& samples, double time_s)
{
    auto const after = std::ranges::find_if(samples, [&](HeadSample const& s) { return s.time_s > time_s; });
    HeadSample const& b = after == samples.end() ? samples.back() : *after;
    HeadSample const& a = after == samples.begin() || after == samples.end() ? b : *(after - 1);
    double const t = b.time_s > a.time_s ? (time_s - a.time_s) / (b.time_s - a.time_s) : 0;
    std::array<double, 5> p{};
    for (std::size_t k = 0; k < 5; ++k) p[k] = glm::mix(a.pose[k], b.pose[k], t);
    gi::dmat4 m = glm::translate(gi::dmat4(1), gi::dvec3(p[0], p[1], p[2]));
    m = glm::rotate(m, glm::radians(p[3]), gi::dvec3(0, 1, 0));
    return glm::rotate(m, glm::radians(p[4]), gi::dvec3(1, 0, 0));
}

/// The camera's place and heading, level.
gi::dmat4 level(gi::dmat4 const& camera)
{
    gi::dvec3 back(camera[2]);
    back.y = 0;
    back = glm::length(back) > 1e-6 ? glm::normalize(back) : gi::dvec3(0, 0, 1);
    gi::dmat4 m(1);
    m[0] = glm::dvec4(glm::cross(gi::dvec3(0, 1, 0), back), 0);
    m[2] = glm::dvec4(back, 0);
    m[3] = camera[3];
    return m;
}

constexpr double kEyeHeight_m = 1.6;

class Walk {
public:
    Walk(Options const& o, gi::Camera const& first, std::optional<Stance> const& stance)
        : o_(o),
          samples_(read_head(o.head)),
          first_(first),
          start_(level(first.world_from_camera)),
          has_body_(!o.avatar.empty()),
          body_(stance)
    {
    }
    double seconds() const { return samples_.back().time_s; }
    void begin(double s) { begun_s = s; } ///< session clock
    Viewpoint at(double time_s, double step_s)
    {
        gi::dmat4 const head = start_ * head_at(samples_, time_s);
        Viewpoint v;
        v.pose_s = v.display_s = begun_s + time_s;
        v.world_from_room = head;
        if (has_body_) {
            v.world_from_room = start_ * glm::translate(gi::dmat4(1), gi::dvec3(0, -kEyeHeight_m, 0));
            v.tracked = body_.before_desktop(glm::inverse(v.world_from_room) * head);
            body_.stand(v.tracked, v.world_from_room, step_s);
        }
        for (int e = 0; e < o_.eyes; ++e) {
            gi::Camera c = first_;
            c.yfov_rad = glm::radians(o_.fov_deg);
            double const aside = o_.eyes == 1 ? 0 : (e - 0.5) * 0.063;
            c.world_from_camera = head * glm::translate(gi::dmat4(1), gi::dvec3(aside, 0, 0));
            v.views.push_back({o_.eyes == 1 ? "window"
                               : e == 0     ? "left eye"
                                            : "right eye",
                               c, o_.width, o_.height, e == 0 ? -1 : 0});
        }
        return v;
    }

private:
    Options const& o_;
    std::vector<HeadSample> samples_;
    gi::Camera first_;
    gi::dmat4 start_;
    bool has_body_;
    UserBody body_;
    double begun_s = 0;
};

/// What was seen at a scored moment.
struct Seen {
    Viewpoint at;
    double scene_s = 0;
    std::vector<std::vector<unsigned char>> shown; ///< per eye
};

std::vector<float> decoded(std::vector<unsigned char> const& bytes)
{
    std::vector<float> linear(bytes.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        float const v = float(bytes[i]) / 255;
        linear[i] = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
    }
    return linear;
}

/// Time of the scene's clips at a moment, if the frame's is that of the moment in which it is seen.
double scene_now(LiveFrame const& f, double now_s)
{
    return f.command.scene_s - f.ahead_s * f.settings.speed +
           f.settings.speed * (f.settings.play ? now_s - f.begun_s : 0);
}

double mean(std::vector<float> const& v) { return std::accumulate(v.begin(), v.end(), 0.0) / double(v.size()); }

/// Mean difference of the eyes' errors (display-encoded, 0..255) at points that both see.
double rivalry(Seen const& s, std::vector<gi::Picture> const& truth,
               std::vector<std::vector<unsigned char>> const& right, gi::dvec3 origin, int w, int h)
{
    gi::CameraRays const a = gi::camera_rays(s.at.views[0].camera, w, h, origin),
                         b = gi::camera_rays(s.at.views[1].camera, w, h, origin);
    gi::Projection const project(b);
    gi::Layer const &da = *truth[0].find("depth"), &db = *truth[1].find("depth");
    double sum = 0;
    std::size_t n = 0;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(w) + std::size_t(x);
            if (!(da.data[i] > 0)) continue;
            gi::Ray const ray = a.through({float(x) + 0.5f, float(y) + 0.5f});
            gi::vec3 const at =
                project(ray.origin + ray.direction * (da.data[i] / glm::dot(ray.direction, a.forward)));
            int const u = int(std::floor(at.x)), v = int(std::floor(at.y));
            if (!(at.z > 0) || u < 0 || v < 0 || u >= w || v >= h) continue;
            std::size_t const j = std::size_t(v) * std::size_t(w) + std::size_t(u);
            if (std::abs(db.data[j] - at.z) > 0.02f * at.z) continue;
            for (std::size_t c = 0; c < 3; ++c)
                sum += std::abs((double(s.shown[0][3 * i + c]) - double(right[0][3 * i + c])) -
                                (double(s.shown[1][3 * j + c]) - double(right[1][3 * j + c])));
            n += 3;
        }
    return n > 0 ? sum / double(n) : 0;
}

void score(Options const& o, RecordedScenes const& scenes, std::vector<Seen> const& seen, gi::dvec3 origin)
{
    if (o.truth.empty()) return;
    fs::create_directories(o.truth);
    gi::Report truth_report;
    std::unique_ptr<RenderSession> exact;
    double flip_sum = 0, flip_most = 0, rivalry_sum = 0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        std::vector<gi::Picture> truth;
        std::vector<std::vector<unsigned char>> right;
        double flip_of_moment = 0;
        for (std::size_t e = 0; e < std::size_t(o.eyes); ++e) {
            // Moments of different runs differ by some ms: the truth is made for each.
            if (!exact) {
                exact = std::make_unique<RenderSession>(scenes.load, 0, truth_report);
                if (scenes.drive) exact->drive_bodies(scenes.drive);
                for (Change const& c : o.settings) exact->apply(c);
                for (Change const& c : std::vector<Change>{{"method", "reference"},
                                                           {"denoise", o.truth_filter},
                                                           {"reuse", 1},
                                                           {"first_surfaces", false}})
                    exact->apply(c);
                exact->apply({"scene", o.scene});
            }
            FrameCommand command;
            command.frame = k;
            command.scene_s = seen[k].scene_s;
            command.world_from_room = seen[k].at.world_from_room;
            command.tracked = seen[k].at.tracked;
            command.views = {seen[k].at.views[e]};
            command.views[0].partner = -1;
            command.paths = o.truth_paths;
            fs::path const kept =
                o.truth / fmt::format("{}_{}_{}x{}_{}_{}_{}_{:.4f}_{}.exr", fs::path(o.scene).stem().string(),
                                      fs::path(o.head).stem().string(), o.width, o.height, o.fov_deg,
                                      o.truth_paths, o.truth_filter, seen[k].scene_s, e);
            if (o.offline_hz > 0 && fs::exists(kept)) {
                truth.push_back(gi::read_exr(kept));
            } else {
                truth.push_back(exact->render(command, {}).views[0].picture);
                std::erase_if(truth.back().layers,
                              [](gi::Layer const& l) { return l.name != "color" && l.name != "depth"; });
                if (o.offline_hz > 0) gi::write_exr(kept, truth.back(), gi::PixelType::single, truth_report);
            }
            right.push_back(gi::tone_map_bytes(*truth.back().find("color"), tone_settings(exact->settings())));
            std::vector<float> const error =
                gi::flip(decoded(seen[k].shown[e]), decoded(right.back()), o.width, o.height);
            flip_sum += mean(error) / double(o.eyes) / double(seen.size());
            flip_of_moment += mean(error);
            flip_most = std::max(flip_most, mean(error));
            std::vector<unsigned char> grey;
            for (float const v : error)
                grey.insert(grey.end(), 3, (unsigned char)(255 * std::clamp(v, 0.0f, 1.0f)));
            auto const save = [&](char const* what, std::vector<unsigned char> const& bytes) {
                gi::write_png(o.out / fmt::format("{}_{}_{}.png", what, k, e), o.width, o.height, bytes);
            };
            save("shown", seen[k].shown[e]);
            save("truth", right.back());
            save("error", grey);
        }
        double const rival = o.eyes == 2 ? rivalry(seen[k], truth, right, origin, o.width, o.height) : 0;
        rivalry_sum += rival / double(seen.size());
        if (o.young > 0)
            fmt::print("  frame {}: FLIP {:.4f}, rivalry {:.2f}/255\n", 1 << k, flip_of_moment / o.eyes, rival);
    }
    fmt::print("  FLIP {:.4f} (most of a moment {:.4f}){}\n", flip_sum, flip_most,
               o.eyes == 2 ? fmt::format("; rivalry {:.2f}/255", rivalry_sum) : "");
}

/// What is shown of a frame at another pose.
Seen reprojected(Options const& o, SessionFrame const& frame, FrameCommand const& command, Viewpoint const& now,
                 Settings const& settings)
{
    auto shown = std::make_shared<LiveFrame>();
    shown->command = command;
    for (ViewPicture const& v : frame.views) shown->result.views.push_back({v.picture, {}, v.hidden});
    PresentSettings present;
    present.tone = tone_settings(settings);
    Seen s{now, command.scene_s, {}};
    std::vector<Pane> panes;
    std::vector<gi::Camera> cameras;
    for (int e = 0; e < o.eyes; ++e) {
        panes.push_back({{0, 0}, {o.width, o.height}, StereoMode::off, e, -1});
        cameras.push_back(now.views[std::size_t(e)].camera);
    }
    Presenter presenter({});
    presenter.take(shown, panes);
    for (int e = 0; e < o.eyes; ++e) {
        TextureTarget const target(TextureTarget::Format::bytes, {o.width, o.height});
        presenter.draw(target.target(), {0, 0}, {panes[std::size_t(e)]}, present, cameras);
        s.shown.push_back(read_bytes(target.target()));
    }
    return s;
}

/// Frames at a fixed rate, each for its own moment, at a fixed scale of light and one path.
void render_offline(Options const& o, RenderSession& session, Walk& walk, std::vector<Seen>& seen)
{
    int const frames = int(walk.seconds() * o.offline_hz);
    for (int f = 0, k = 0; o.young > 0 ? f < o.young : f < frames && k < o.scored; ++f) {
        double const t = o.young > 0 ? 0 : f / o.offline_hz;
        Viewpoint const at = walk.at(std::max(0.0, t - o.late_s), 1 / o.offline_hz);
        FrameCommand command;
        command.frame = std::uint64_t(f);
        command.scene_s = t;
        command.world_from_room = at.world_from_room;
        command.tracked = at.tracked;
        command.views = at.views;
        command.light_scale = o.light_scale;
        command.surface_scale = o.surface_scale;
        command.paths = o.paths;
        if (!session.settings().first_surfaces) {
            command.light_scale = command.surface_scale = 1;
            for (ViewCommand& v : command.views)
                v.width = int(v.width * o.light_scale), v.height = int(v.height * o.light_scale);
        }
        SessionFrame const frame = session.render(command, {});
        if (o.young > 0 ? ((f + 1) & f) != 0 : t < 1 + (walk.seconds() - 1) * (k + 0.5) / o.scored) continue;
        ++k;
        if (o.late_s > 0) {
            seen.push_back(reprojected(o, frame, command, walk.at(t, 0), session.settings()));
            continue;
        }
        Seen s{at, t, {}};
        for (ViewPicture const& v : frame.views) {
            std::vector<unsigned char> const bytes =
                gi::tone_map_bytes(*v.picture.find("color"), tone_settings(session.settings()));
            std::vector<unsigned char> full(std::size_t(o.width) * std::size_t(o.height) * 3);
            for (int y = 0; y < o.height; ++y)
                for (int x = 0; x < o.width; ++x)
                    for (int c = 0; c < 3; ++c)
                        full[std::size_t(3 * (y * o.width + x) + c)] =
                            bytes[std::size_t(3 * (y * v.picture.height / o.height * v.picture.width +
                                                   x * v.picture.width / o.width) +
                                              c)];
            s.shown.push_back(std::move(full));
        }
        seen.push_back(std::move(s));
    }
}

void run(Options const& o)
{
    fs::create_directories(o.out);
    gi::Report report;
    GlContext const gl = GlContext::surfaceless(report);
    std::vector<AvatarChoice> const avatars = avatar_choices(o.avatar, kEyeHeight_m, {}, {});
    RecordedScenes const scenes = scenes_with({}, avatars, report);
    RenderSession session(scenes.load, 0, report);
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
    hooks.finished = [&](LiveFrame const& f) {
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
    double draw_s = 0;
    double begun = 0;
    std::size_t first_frame = 0;
    {
        LiveRenderer renderer(session, clock, nullptr, hooks);
        Presenter presenter({});
        PresentSettings settings;
        settings.tone = tone_settings(session.settings());
        std::vector<Pane> panes;
        std::vector<TextureTarget> targets;
        for (int e = 0; e < o.eyes; ++e) {
            panes.push_back({{0, 0}, {o.width, o.height}, StereoMode::off, e, -1});
            targets.emplace_back(TextureTarget::Format::bytes, glm::ivec2(o.width, o.height));
        }
        renderer.look(walk.at(0, 0));
        if (!renderer.next_frame(60)) throw gi::InputError("no frame in 60 s", "", "");
        std::shared_ptr<LiveFrame const> shown;
        begun = clock.now_s();
        walk.begin(begun);
        first_frame = done_s.size();
        std::map<std::string, double>().swap(stages_s);
        light_scale = surfaces = paths = 0;
        double last = 0;
        for (int k = 0; k < o.scored;) {
            double const now = clock.now_s() - begun;
            Viewpoint const at = walk.at(now, now - last);
            last = now;
            std::vector<gi::Camera> cameras;
            for (ViewCommand const& v : at.views) cameras.push_back(v.camera);
            renderer.look(at);
            auto const newest = renderer.newest();
            if (newest != shown) presenter.take(newest, panes);
            shown = newest;
            double const drawing = clock.now_s();
            for (int e = 0; e < o.eyes; ++e)
                presenter.draw(targets[std::size_t(e)].target(), {0, 0}, {panes[std::size_t(e)]}, settings,
                               cameras);
            ++presented;
            glFinish();
            draw_s += clock.now_s() - drawing;
            // The first second is not scored.
            if (now >= 1 + (walk.seconds() - 1) * (k + 0.5) / o.scored) {
                Seen s{at, scene_now(*newest, begun + now), {}};
                for (TextureTarget const& t : targets) s.shown.push_back(read_bytes(t.target()));
                seen.push_back(std::move(s));
                ++k;
            } else if (!targets.empty()) {
                read_bytes(part_of(targets[0].target(), {0, 0}, {1, 1})); // waits as a swap does
            }
            double const drew_s = clock.now_s() - drawing;
            double const next_s = std::max(now + 1.0 / 60, begun + now + 5 * drew_s - begun);
            while (clock.now_s() - begun < next_s) { // as the window's loop does
                double const t = clock.now_s() - begun;
                if (t - last > 0.004) {
                    renderer.look(walk.at(t, t - last));
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
    std::ranges::sort(gaps);
    double const frames = double(std::max<std::size_t>(1, gaps.size()));
    fmt::print(
        "{} {} {}x{} x{}: {:.1f} frames/s rendered, {:.1f} shown; ms between frames: median {:.0f}, 95 % {:.0f}, "
        "most {:.0f}; drawn in {:.1f} ms; scale of light {:.3f}, of surfaces {:.3f}, paths {:.1f}\n",
        o.scene, fs::path(o.head).stem().string(), o.width, o.height, o.eyes, frames / took, presented / took,
        gaps[gaps.size() / 2], gaps[gaps.size() * 95 / 100], gaps.back(), 1e3 * draw_s / presented,
        light_scale / frames, surfaces / frames, paths / frames);
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
