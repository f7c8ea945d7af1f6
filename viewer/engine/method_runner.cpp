#include "viewer/engine/method_runner.h"

#include "gi/filter/filter_names.h"
#include "gi/filter/reused_light.h"
#include "gi/methods/paths/settings.h"
#include "gi/scene/model/projection.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <tbb/parallel_for.h>
#include <tuple>
#include <utility>

namespace viewer {
namespace {

/// A still picture is filtered while it has few paths, then less and less, so that it converges to the method's
/// own result without a leap.
constexpr float kFiltered = 48, kUnfiltered = 1024; // paths per pixel
/// Where light does not change, temporal reuse averages over this many times the frames of the setting.
constexpr int kUnchanged = 8;
/// Light is reused from the other eye only in this many frames after a change.
constexpr int kSharedFrames = 16;

/// Orthographic cameras have no motion vectors: no temporal reuse while anything moves.
void without_motion(gi::Picture& picture)
{
    if (picture.find("motion") != nullptr) return;
    gi::Layer& motion = picture.add("motion", 3);
    std::fill(motion.data.begin(), motion.data.end(), std::numeric_limits<float>::quiet_NaN());
}

/// Light for the surfaces of this picture from an earlier picture of another size or viewpoint.
/// @param punctual  share of the light of punctual lights that it lacks
std::vector<gi::KnownLight> known_light(gi::KeptLight const& before, gi::Picture const& picture, gi::dvec3 origin,
                                        float punctual, gi::SeenSurfaces* seen, gi::CameraRays const& rays)
{
    constexpr float kWorth = 8, kAlike = 0.3f; // frames; likeness
    std::vector<gi::KnownLight> known(picture.pixels());
    gi::Layer const &normal = *picture.find("normal"), &position = *picture.find("position");
    bool const lights = punctual != 0 && seen != nullptr;
    if (lights) seen->look(rays, picture.width, picture.height, gi::SeenSurfaces::Lights::few);
    tbb::parallel_for(0, picture.height, [&](int y) {
        thread_local std::vector<gi::SeenSurface> row;
        row.assign(std::size_t(picture.width), {});
        if (lights) seen->row(y, row);
        for (int x = 0; x < picture.width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(picture.width) + std::size_t(x);
            gi::vec3 const n = gi::rgb(normal, i);
            if (n == gi::vec3{0}) continue;
            auto const found = before.find(gi::vec3(gi::dvec3(gi::rgb(position, i)) - origin), n);
            if (found && found->likeness > kAlike) known[i] = {found->direct, found->indirect, kWorth};
            gi::SeenSurface const& s = row[std::size_t(x)];
            for (int c = 0; c < 3 && lights; ++c)
                if (s.albedo[c] > 0.01f)
                    known[i].direct[c] = std::max(0.0f, known[i].direct[c] + punctual * s.direct[c] / s.albedo[c]);
        }
    });
    return known;
}

/// Per pixel of `here`: the pixel of `there`, the other eye's picture, that shows the same point, within 2 % of its
/// distance; gi::kOwnLight if there is none. Both need the layer position. @param rays  camera of `there`
std::vector<std::uint32_t> same_surfaces(gi::Picture const& here, gi::Picture const& there,
                                         gi::CameraRays const& rays, gi::dvec3 origin)
{
    constexpr float kNear = 0.02f; // of the distance
    std::vector<std::uint32_t> same(here.pixels(), gi::kOwnLight);
    gi::Layer const* const from = here.find("position");
    gi::Layer const* const to = there.find("position");
    gi::Layer const* const normal = here.find("normal");
    if (from == nullptr || to == nullptr || normal == nullptr) return same;
    gi::Projection const project(rays);
    tbb::parallel_for(0, here.height, [&](int y) {
        for (int x = 0; x < here.width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(here.width) + std::size_t(x);
            if (gi::rgb(*normal, i) == gi::vec3{0}) continue;
            gi::vec3 const point = gi::rgb(*from, i), at = project(gi::vec3(gi::dvec3(point) - origin));
            if (!(at.z > 0) ||
                !(at.x >= 0 && at.x < float(there.width) && at.y >= 0 && at.y < float(there.height)))
                continue;
            std::size_t const j = std::size_t(at.y) * std::size_t(there.width) + std::size_t(at.x);
            if (glm::distance(gi::rgb(*to, j), point) <= kNear * at.z) same[i] = std::uint32_t(j);
        }
    });
    return same;
}

bool same_pixels(HiddenPixels const& a, HiddenPixels const& b) { return a == b || (a && b && *a == *b); }

/// Share of the filtered picture in what is shown.
float filtered_share(double paths)
{
    return std::clamp(1 - std::log2(float(paths) / kFiltered) / std::log2(kUnfiltered / kFiltered), 0.0f, 1.0f);
}

/// Replaces light by (1 - share) of what it was before the filter.
void mix_light(gi::Picture& picture, gi::Picture const& unfiltered, float share)
{
    for (char const* const name : {"color", "L0", "L1", "L2"}) {
        gi::Layer* const to = picture.find(name);
        gi::Layer const* const from = unfiltered.find(name);
        if (to == nullptr || from == nullptr) continue;
        tbb::parallel_for(std::size_t(0), to->data.size(),
                          [&](std::size_t i) { to->data[i] = glm::mix(from->data[i], to->data[i], share); });
    }
}

} // namespace

gi::SceneChange scene_change(gi::Changes const& c, bool camera_moved)
{
    if (c.lights || c.materials || c.coverage || c.emitters || c.environment) return gi::SceneChange::light;
    return c.geometry || camera_moved ? gi::SceneChange::motion : gi::SceneChange::nothing;
}

MethodRunner::MethodRunner(std::string const& method, gi::MovingWorld const& world, Settings const& settings,
                           int threads, SceneStart const& start, gi::Report& report, bool ahead)
    : method_(gi::find_method(method)),
      report_(report),
      threads_(threads),
      origin_(world.world().origin),
      ahead_(ahead)
{
    gi::RenderSettings s = settings.render;
    s.threads = threads;
    s.paths = 1;
    s.width = std::max(1, int(std::sqrt(start.pixels))); // the plan needs only the number of pixels
    s.height = std::max(1, int(std::lround(start.pixels / s.width)));
    if (method_.for_display != nullptr) s = method_.for_display(std::move(s));
    if (method_.choose != nullptr) {
        gi::MethodChoice const c = method_.choose(world.world(), s, start.camera, gi::RenderUse::frames);
        choice_ = fmt::format("{} chose {}: {}", method_.name, c.method, c.why.text);
    }
    renderer_ = method_.frames(world, start.camera, s, report);
}

std::vector<gi::RenderResult>
MethodRunner::render(FrameCommand const& command, std::span<HiddenPixels const> hidden, gi::Changes const& changes,
                     Settings const& settings, gi::SeenSurfaces* seen, bool leaves_out_punctual,
                     gi::StopRequest const& stop, OnStop on_stop, gi::FrameView const& around)
{
    auto* const punctual = gi::ask<gi::PunctualLeftOut>(*renderer_);
    if (punctual != nullptr) punctual->leave_out_punctual(leaves_out_punctual);
    left_out_punctual_ = punctual != nullptr && leaves_out_punctual;
    if (!first_ || ahead_) renderer_->changed(changes);
    bool const small = command.light_scale < 1;
    std::vector<Next> next;
    Seen const none;
    bool anything_moved = first_ || state_.seen.size() != command.views.size() || changes.any();
    for (std::size_t k = 0; k < command.views.size(); ++k) {
        ViewCommand const& now = command.views[k];
        Seen const& s = k < state_.seen.size() ? state_.seen[k] : none;
        bool const follows = s.name == now.name && s.width == now.width && s.height == now.height;
        bool const same = s.reuse && follows && s.most_frames == settings.reuse &&
                          s.punctual != left_out_punctual_ && s.small == small;
        bool const moved = !same || !(s.camera == now.camera) || !same_pixels(s.hidden, hidden[k]);
        anything_moved |= moved;
        gi::CameraRays const rays = gi::camera_rays(now.camera, now.width, now.height, origin_);
        next.push_back({same, moved, rays, follows ? s.rays : rays});
    }
    int const still = anything_moved ? 1 : state_.still + 1;
    std::vector<gi::FrameView> views;
    for (std::size_t k = 0; k < command.views.size(); ++k) {
        ViewCommand const& v = command.views[k];
        views.push_back(
            {v.camera, v.width, v.height, settings.share_eyes && still <= kSharedFrames ? v.partner : -1});
        if (hidden[k]) views.back().hidden = *hidden[k];
        // A smaller picture is of light only: nobody sees its outlines, and their
        // pixels show one surface for longer.
        if (small) views.back().filter = gi::PixelFilter::centre;
    }
    if (around.width > 0) views.push_back(around);
    // The blur of a radiance cache would stay in the mean of a still picture; pictures of light alone are replaced.
    auto const sharing =
        anything_moved || command.only_light ? gi::VertexSharing::cached : gi::VertexSharing::exact;
    if (auto* const live = gi::ask<gi::LiveSettings>(*renderer_)) live->follow(settings.render);
    if (auto* const axes = gi::ask<gi::FollowingAxes>(*renderer_))
        axes->update_axes(gi::updates_axes(method_, settings.render) ? settings.updated_axes : 0);
    auto* const given_up = gi::ask<gi::FramesGivenUp>(*renderer_);
    bool const is_first = std::exchange(first_, false),
               may_give_up = given_up != nullptr && on_stop == OnStop::give_up && !is_first && !changes.any();
    if (may_give_up) given_up->may_give_up();
    std::vector<gi::RenderResult> results = renderer_->views(views, std::uint32_t(command.paths), sharing, stop);
    around_ = {};
    if (around.width > 0) {
        around_ = gi::light_picture(results.back().picture, around.camera, results.back().picture.pixels());
        results.pop_back();
    }
    bool const can_undo = may_give_up && given_up->can_undo();
    gi::StopRequest const* const filters_stop = can_undo ? &stop : nullptr;
    State before = state_; // shares what it holds
    std::size_t averaged = 0;
    std::vector<gi::MirrorLayers> mirrors;
    std::vector<std::shared_ptr<gi::KeptLight const>> lights;
    state_.still = still;
    // Counts the paths actually traced: for a stopped frame, a replay is given only these.
    state_.still_paths = (anything_moved ? 0 : state_.still_paths) + results[0].paths;
    follow(command, hidden, next, settings);
    try {
        for (; averaged < results.size(); ++averaged) {
            if (can_undo && stop.requested()) throw gi::Interrupted();
            mirrors.push_back(reuse(averaged, results, views[averaged].partner,
                                    scene_change(changes, next[averaged].moved), settings, seen));
        }
        bool const filtered = is_filtered(results[0], settings);
        if (filtered && settings.reuse > 1)
            for (std::size_t k = 0; k < results.size(); ++k) hold_guides(k, results[k].picture);
        std::vector<gi::Picture> unfiltered(results.size());
        for (std::size_t k = 0; k < results.size() && filtered && filtered_share(state_.still_paths) < 1; ++k)
            unfiltered[k] = results[k].picture;
        if (filtered) clamp(results, command.views, filters_stop);
        for (std::size_t k = 0; k < results.size(); ++k) {
            if (filtered) filter(k, results, views[k].partner, settings, unfiltered[k], filters_stop);
            Seen const& own = state_.seen[k];
            bool const kept = seen != nullptr && !own.rays.orthographic;
            lights.push_back(kept ? std::make_shared<gi::KeptLight>(results[k].picture, own.rays, origin_)
                                  : nullptr);
            gi::describe_mirrors(mirrors[k], results[k].picture);
        }
    } catch (gi::Interrupted const&) {
        if (can_undo) {
            for (std::size_t k = 0; k < averaged && settings.reuse > 1; ++k)
                if (next[k].same) state_.seen[k].reuse->undo();
            state_ = std::move(before);
            given_up->undo();
        }
        throw;
    }
    if (can_undo) given_up->keep();
    images_.clear();
    for (std::size_t k = 0; k < results.size(); ++k) {
        state_.seen[k].light = std::move(lights[k]);
        images_.push_back(std::move(mirrors[k].images));
    }
    return results;
}

/// Makes the views of this frame those that are seen.
void MethodRunner::follow(FrameCommand const& command, std::span<HiddenPixels const> hidden,
                          std::span<Next const> next, Settings const& settings)
{
    bool const small = command.light_scale < 1;
    state_.seen.resize(command.views.size());
    for (std::size_t k = 0; k < command.views.size(); ++k) {
        ViewCommand const& now = command.views[k];
        Seen& s = state_.seen[k];
        if (!next[k].same) {
            gi::TemporalSettings by{settings.reuse, kUnchanged * settings.reuse};
            if (small) std::tie(by.window, by.spread, by.keep_normals) = std::tuple(17, 2.0f, true);
            by.follow_sudden = small;
            by.can_undo = true;
            s.reuse = std::make_shared<gi::TemporalReuse>(by);
        }
        s = {now.name,       now.camera,      now.width,          now.height, std::move(s.reuse),
             settings.reuse, hidden[k],       std::move(s.light), s.punctual, small,
             next[k].rays,   next[k].earlier, std::move(s.guides)};
    }
}

gi::ReusedLight MethodRunner::taken(std::size_t view, int partner, Results const& results) const
{
    if (results[view].light_from.empty()) return {};
    return {&results[std::size_t(partner)].picture, results[view].light_from};
}

bool MethodRunner::is_filtered(gi::RenderResult const& result, Settings const& settings) const
{
    return filtered_share(state_.still_paths) > 0 &&
           gi::can_filter(denoise_settings(settings, threads_), result.paths, settings.reuse > 1);
}

gi::MirrorLayers MethodRunner::reuse(std::size_t view, Results& results, int partner, gi::SceneChange change,
                                     Settings const& settings, gi::SeenSurfaces* seen)
{
    gi::RenderResult& result = results[view];
    Seen& own = state_.seen[view];
    if (own.rays.orthographic) seen = nullptr;
    gi::MirrorLayers mirrors;
    if (seen != nullptr && seen->may_show_mirrors(own.rays, own.width, own.height)) {
        gi::StageTimer const timer(report_, "surfaces in mirrors");
        seen->look(own.rays, own.width, own.height);
        mirrors = gi::describe_mirrored(*seen, own.rays, own.earlier, origin_, result.picture);
    }
    if (settings.reuse > 1) {
        gi::StageTimer const timer(report_, "temporal reuse");
        without_motion(result.picture);
        if (own.light && own.reuse->is_new()) {
            float const add =
                own.punctual ? (left_out_punctual_ ? -1.0f : 0.0f) : (left_out_punctual_ ? 0.0f : 1.0f);
            own.reuse->begin_with(known_light(*own.light, result.picture, origin_, add, seen, own.rays));
        }
        gi::ReusedLight const from = taken(view, partner, results);
        own.reuse->add(result.picture, change,
                       from.partner ? state_.seen[std::size_t(partner)].reuse.get() : nullptr, from.from);
    }
    own.punctual = !left_out_punctual_;
    return mirrors;
}

void MethodRunner::hold_guides(std::size_t view, gi::Picture& picture)
{
    constexpr std::array kGuides{"normal", "position"};
    std::shared_ptr<gi::Picture const>& held = state_.seen[view].guides;
    if (state_.still > 1 && held && held->width == picture.width && held->height == picture.height) {
        for (char const* const name : kGuides) *picture.find(name) = *held->find(name);
        return;
    }
    auto now = std::make_shared<gi::Picture>(gi::Picture{picture.width, picture.height, {}, {}});
    for (char const* const name : kGuides)
        if (gi::Layer const* const layer = picture.find(name)) now->layers.push_back(*layer);
    held = now->layers.size() == kGuides.size() ? now : nullptr;
}

void MethodRunner::clamp(Results& results, std::span<ViewCommand const> views, gi::StopRequest const* stop)
{
    gi::StageTimer const timer(report_, "fireflies");
    gi::FireflyCounts& counts = state_.fireflies;
    std::vector<std::vector<gi::Firefly>> found;
    for (std::size_t k = 0; k < results.size(); ++k) {
        gi::FireflyView view{&results[k].picture, results[k].light_from, nullptr, {}, stop};
        // The other eye: a view's partner, or the view whose partner it is, unless that has taken its light.
        std::size_t other = results.size();
        for (std::size_t j = 0; j < results.size(); ++j)
            if (views[k].partner == int(j) || (views[j].partner == int(k) && results[j].light_from.empty()))
                other = j;
        std::vector<std::uint32_t> same;
        if (other < results.size()) {
            view.other = &results[other].picture;
            same = same_surfaces(*view.picture, *view.other, state_.seen[other].rays, origin_);
            view.same = same;
        }
        found.push_back(gi::find_fireflies(view, counts));
    }
    for (std::size_t k = 0; k < results.size(); ++k) {
        gi::clamp_fireflies(results[k].picture, found[k]);
    }
    report_.count("fireflies clamped", double(counts.clamped));
    report_.count("fireflies clamped, as the other eye does not see them", double(counts.by_eye));
    report_.count("pixels searched for fireflies", double(counts.pixels));
    report_.count("light of fireflies spread around them, share",
                  counts.light > 0 ? counts.moved / counts.light : 0);
}

void MethodRunner::filter(std::size_t view, Results& results, int partner, Settings const& settings,
                          gi::Picture const& unfiltered, gi::StopRequest const* stop)
{
    gi::StageTimer const timer(report_, "denoise");
    gi::DenoiseSettings by = denoise_settings(settings, threads_);
    by.stop = stop;
    gi::Picture& picture = results[view].picture;
    gi::DenoiseReport const done = gi::denoise(picture, by, taken(view, partner, results));
    if (done.not_finite > 0) report_.lose("pixels not filtered, as a value is not finite", done.not_finite);
    if (!unfiltered.layers.empty()) mix_light(picture, unfiltered, filtered_share(state_.still_paths));
}

} // namespace viewer
