#include "gi/methods/paths/renderer.h"

#include "gi/core/step.h"
#include "gi/methods/paths/choose.h"
#include "gi/methods/paths/lobes.h"
#include "gi/render/pass_samples.h"
#include "gi/scene/model/plan.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Choosing among axes and light points only needs their grids.
std::uint32_t texels(bool unused, int n) { return std::uint32_t(unused ? 2 : n); }

} // namespace

PathsRenderer::PathsRenderer(World const& world, std::span<FrameView const> views, RenderSettings const& settings,
                             TriangleSoup soup, std::size_t first_moving, Report& report,
                             FirstSurfaces first_surfaces, StopRequest const* stop)
    : world_(world),
      settings_(settings),
      first_surfaces_(first_surfaces),
      stop_(stop),
      report_(report),
      traced_(world, std::move(soup), first_moving, slhb_),
      axes_(slhb_, report),
      paths_(world, settings_, report)
{
    shadow_maps_ = by_.shadows == ShadowsBy::maps;
    see(views);
    build_exact();
    end_frame();
    make_axes();
    make_light_points();
    if (own_.cache != RadianceCaching::off && settings_.bounces > 0)
        cache_.emplace(world.bounds.radius(), std::size_t(slhb_.memory_mib) << 20);
}

bool PathsRenderer::gathers() const
{
    return by_.layered_lens &&
           std::ranges::all_of(views_, [](SeenView const& v) { return v.rays.has_lens() || !v.during.empty(); });
}

bool PathsRenderer::orthographic() const
{
    return std::any_of(views_.begin(), views_.end(), [](SeenView const& v) { return v.rays.orthographic; });
}

void PathsRenderer::build_exact()
{
    if (exact_ || !needs_exact_rays(world_, orthographic(), settings_)) return;
    StageTimer const timer(report_, "build (Embree BVH)");
    exact_ = std::make_unique<ExactVisibility>(world_, plan_scene(world_).alpha_tests, settings_.threads,
                                               traced_.first_moving, stop_of_building(stop_));
}

bool PathsRenderer::walks() const
{
    return by_.surfaces == SurfacesBy::look_ups && (settings_.bounces > 0 || meets_light(world_));
}

void PathsRenderer::make_axes()
{
    axes_.make({.bounds = traced_.grid_bounds,
                .windows = traced_.windows.boxes(),
                .soup = traced_.soup,
                .cut_outs = traced_.cut_outs,
                .resolution = texels(slhb_.exact.queries, slhb_.resolution),
                .most_layers = std::uint32_t(slhb_.most_layers),
                .packed = slhb_.packed,
                .seed = settings_.seed,
                .most_bytes = std::size_t(slhb_.memory_mib) << 20,
                .stop = stop_,
                .first_moving = traced_.first_moving},
               walks());
}

void PathsRenderer::make_light_points()
{
    if (light_points_) earlier_maps_ += light_points_->maps_built();
    light_points_.emplace(world_, traced_.grid_bounds, traced_.soup, traced_.cut_outs,
                          LightPointSettings{.count = std::uint32_t(shadow_maps_ ? slhb_.light_samples : 0),
                                             .fresh = std::uint32_t(slhb_.fresh_light_samples),
                                             .resolution = texels(slhb_.exact.shadows, slhb_.shadow_resolution),
                                             .windows = traced_.windows.boxes(),
                                             .seed = settings_.seed,
                                             .first_moving = traced_.first_moving,
                                             .stop = stop_});
}

void PathsRenderer::changed(Changes const& c)
{
    if (c.geometry || c.materials || c.coverage || c.lights || c.emitters || c.environment || c.light_select)
        forget();
    if (c.materials || c.environment) materials_changed();
    bool const lights = changes_lights(c);
    if (c.geometry || lights) world_moved(c.geometry, lights);
}

void PathsRenderer::world_moved(bool geometry, bool lights)
{
    if (geometry) {
        {
            StageTimer const timer(report_, "update of dynamic triangles");
            traced_.move(world_);
        }
        {
            StageTimer const timer(report_, "BVH of dynamic triangles (Embree)");
            if (exact_) exact_->moved(world_);
        }
        if (!traced_.outgrown(world_, slhb_.schedule, report_)) {
            axes_.set().moved();
        } else {
            traced_.place_windows(views_);
            make_axes();
            lights = true; // the maps of parallel lights depend on the same bounds
        }
        light_points_->moved();
    }
    if (lights) make_light_points();
}

void PathsRenderer::materials_changed()
{
    if ((exact_ != nullptr) != needs_exact_rays(world_, orthographic(), settings_)) {
        exact_.reset();
        build_exact();
    }
    if (axes_.walks() != walks()) make_axes();
}

void PathsRenderer::end_frame()
{
    axes_.end_frame();
    traced_.end_frame();
    for (SeenView& v : views_) v.earlier = v.rays;
}

void PathsRenderer::add_motion(std::size_t view, Picture& picture) const
{
    SeenView const& v = views_[view];
    if (v.primary) gi::add_motion(*v.primary, traced_.soup, v.rays, v.earlier, traced_.earlier, picture);
}

void PathsRenderer::see(std::span<FrameView const> views)
{
    bool const flat = std::ranges::any_of(views, [](FrameView const& v) { return v.camera.orthographic; });
    if (by_.surfaces == SurfacesBy::screen && flat)
        throw InputError("--method screen_lhb with an orthographic camera",
                         "its layers are those of a pinhole view",
                         "choose a perspective camera, or another method");
    std::size_t first = 0;
    while (views_.size() > views.size()) views_.pop_back();
    for (std::size_t k = 0; k < views.size(); ++k) {
        FrameView const& now = views[k];
        if (k == views_.size()) views_.emplace_back();
        SeenView& v = views_[k];
        bool const known = v.follow(now, world_.origin, settings_.filter);
        v.during.clear();
        for (Camera const& c : now.during)
            if (!c.orthographic) v.during.push_back(camera_rays(c, v.width, v.height, world_.origin));
        v.partner = now.partner;
        v.hidden = now.hidden;
        v.first = first;
        first += v.pixels();
        fit_primary(v, known);
    }
    if (!exact_ && orthographic()) build_exact(); // orthographic cameras are not rasterised
    bool const looks_up = by_.surfaces == SurfacesBy::look_ups || by_.shadows == ShadowsBy::maps;
    if (looks_up && traced_.place_windows(views_) && light_points_) {
        make_axes();
        make_light_points();
    }
}

std::optional<PathsRenderer::Before> PathsRenderer::before(bool teaches) const
{
    constexpr std::size_t kMostCopied = 256u << 20; // bytes
    if (!cache_ || !teaches) return Before{{views_.begin(), views_.end()}, cache_ ? cache_->passes() : 0, {}};
    if (cache_->bytes() > kMostCopied) return {};
    return Before{{views_.begin(), views_.end()}, cache_->passes(), cache_};
}

void PathsRenderer::go_back(Before&& before)
{
    if (before.cache)
        cache_ = std::move(before.cache);
    else if (cache_)
        cache_->go_back(before.cache_passes);
    std::vector<TracedView> const& seen = before.views;
    views_.resize(seen.size());
    std::size_t first = 0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        SeenView& v = views_[k];
        bool const same = v.width == seen[k].width && v.height == seen[k].height;
        static_cast<TracedView&>(v) = seen[k];
        v.first = first;
        first += v.pixels();
        fit_primary(v, same);
    }
}

void PathsRenderer::fit_primary(SeenView& v, bool has_same_size)
{
    if (v.rays.orthographic || first_surfaces_ == FirstSurfaces::by_rays)
        v.primary.reset();
    else if (!has_same_size || !v.primary)
        v.primary.emplace(traced_.soup, traced_.cut_outs, settings_, v.width, v.height);
    if (v.primary) v.primary->set_filter(v.filter);
}

void PathsRenderer::prepare(std::uint32_t index, Sides sides, PassStop const& stop)
{
    axes_.prepare(settings_.bounces + (meets_light(world_) ? 1 : 0), index);
    {
        StageTimer const timer(report_, "shadow maps");
        light_points_->refresh(index, stop);
    }
    StageTimer const timer(report_, "G-buffer");
    for (SeenView& v : views_) {
        stop.check();
        CameraRays eye = eye_of_pass(v.rays, settings_.seed, index);
        float const near_m = near_plane(world_.bounds);
        if (by_.surfaces == SurfacesBy::screen) {
            auto const draw = [&](std::optional<ScreenLayers>& layers, std::size_t last) {
                if (!layers) layers.emplace();
                layers->draw(traced_.soup, last, traced_.cut_outs, eye, v.width, v.height,
                             std::uint32_t(slhb_.resolution),
                             place_in_pixel(PixelFilter::box, settings_.seed, index), near_m,
                             std::uint32_t(mix_bits(settings_.seed) + index));
            };
            draw(v.screen, traced_.soup.count);
            if (sides == Sides::pair) draw(v.screen_behind, std::min(traced_.first_moving, traced_.soup.count));
        }
        bool const lens = sides == Sides::one && gathers();
        if (!lens) {
            v.lens.reset();
        } else {
            if (!v.lens) v.lens.emplace();
            if (v.rays.has_lens()) eye = v.rays.at_lens(vec2{0});
            v.lens->look(lens_view(v, settings_.seed, index),
                         {traced_.soup, traced_.cut_outs, view(world_), *exact_}, near_m, stop);
        }
        if (!v.primary || !v.during.empty()) continue;
        if (sides == Sides::pair)
            v.primary->refresh_pair(eye, near_m, index, traced_.first_moving);
        else
            v.primary->refresh(eye, near_m, index);
    }
}

PathsTracer::Pass PathsRenderer::tracing(std::uint32_t index, bool cached, PassStop& stop)
{
    bool const walks = axes_.walks();
    std::uint32_t const gathered = slhb_.gather && walks
                                       ? index / std::uint32_t(own_.interleave * own_.interleave) %
                                             std::uint32_t(axes_.set().first_bounce_axes())
                                       : kNoPrimitive;
    if (!shadow_maps_) {
        light_order_.update(world_);
        lights_.fill(light_order_, world_,
                     LightPool::groups_for(views_.back().first + views_.back().pixels(), world_), settings_.seed,
                     index);
    }
    sky_.clear();
    if (walks && !slhb_.exact.directions) sky_ = sky_along(axes_.set(), world_);
    return {.axes = axes_.set(),
            .light_points = *light_points_,
            .exact = exact_.get(),
            .stop = stop,
            .index = index,
            .gather_axis = gathered,
            .sky = sky_,
            .lights = shadow_maps_ ? nullptr : &lights_,
            .smooth = smooth_somewhere(world_),
            .look_ups = !slhb_.exact.queries && by_.surfaces == SurfacesBy::look_ups,
            .exact_shadows = slhb_.exact.shadows,
            .confirms = slhb_.confirm == Confirming::on,
            .cache = cached && cache_ ? &*cache_ : nullptr,
            .spread = spread_ && by_.surfaces != SurfacesBy::look_ups,
            .no_punctual = leaves_out_punctual_,
            .caustics = caustics_ ? caustics_->map() : nullptr};
}

void PathsRenderer::pass(std::uint32_t index, std::span<Accumulator> sums, VertexSharing sharing, PassStop stop)
{
    prepare(index, Sides::one, stop);
    if (caustics_) caustics_->prepare(*exact_, index, BuildStop(stop_), sums[0].counts);
    StageTimer const timer(report_, "paths");
    PathsTracer::Pass const tracing = this->tracing(index, sharing == VertexSharing::cached, stop);
    if (gathers())
        paths_.trace_lenses(tracing, views_, sums);
    else
        paths_.trace(tracing, views_, sharing, sums);
    if (by_.layered_lens && !gathers() &&
        std::ranges::any_of(views_, [](SeenView const& v) { return v.rays.has_lens(); }))
        report_.lose("passes whose lens was sampled, not gathered from layers, as another view has none", 1);
    if (control_) paths_.control(tracing, views_[0], *control_);
    if (cache_) cache_->end_pass();
    for (Accumulator& s : sums) ++s.paths;
}

void PathsRenderer::pair_pass(std::uint32_t index, PairSums& sums, PathCounts& counts)
{
    if (!std::exchange(shadow_maps_, true))
        make_light_points(); // shadow maps show which paths change
    PassStop never(nullptr);
    prepare(index, Sides::pair, never);
    StageTimer const timer(report_, "paths");
    PathsTracer::Pass now = tracing(index, false, never);
    now.first_watched = std::uint32_t(traced_.first_moving);
    // The world is not changed: look-ups ignore dynamic geometry.
    auto const show_moving = [&](bool shown) {
        axes_.set().show_moving(shown);
        light_points_->show_moving(shown);
    };
    paths_.trace_pair(now, views_, show_moving, sums, counts);
}

void PathsRenderer::add_coverage(std::size_t view, std::span<float> counts, std::span<vec3> radiance) const
{
    SeenView const& v = views_[view];
    if (!v.primary) return;
    constexpr std::size_t kBlock = 4096;
    std::span const samples = paths_.samples(v);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, counts.size(), kBlock), [&](auto const& range) {
        for (std::size_t p = range.begin(); p != range.end(); ++p) {
            std::uint32_t const t = v.primary->triangle(p);
            if (t == kNoPrimitive || t < traced_.first_moving) continue;
            counts[p] += 1;
            for (vec3 const part : samples[p].radiance) radiance[p] += part;
        }
    });
}

std::span<std::uint32_t const> PathsRenderer::light_from(std::size_t view) const
{
    SeenView const& v = views_[view];
    return v.partner < 0 ? std::span<std::uint32_t const>() : paths_.light_from(v);
}

void PathsRenderer::report_work() const
{
    paths_.report_work();
    axes_.report_work();
    report_.count("shadow maps built", double(earlier_maps_ + light_points_->maps_built()));
    if (!cache_) return;
    report_.count("cells of the radiance cache", double(cache_->cells()));
    report_.count("bytes of the radiance cache", double(cache_->bytes()));
}

} // namespace gi
