#include "gi/methods/paths/kernels/kernel_renderer.h"

#include "gi/methods/paths/lobes.h"
#include "gi/render/pass_samples.h"
#include "gi/scene/model/plan.h"

#include <algorithm>
#include <new>

namespace gi {

template <Space S>
void KernelRenderer<S>::check(Camera const& camera, RenderSettings const& settings)
{
    SlhbSettings const& s = settings.of<SlhbSettings>();
    PathsSettings const& own = settings.of<PathsSettings>();
    char const* const suggestion = "leave it out, or render with --device cpu";
    if (camera.orthographic)
        throw InputError("--device cuda with an orthographic camera",
                         "its first surfaces are drawn, which only perspective cameras can",
                         "choose a perspective camera, or --device cpu");
    if (s.cone > 0) throw InputError("--device cuda with --cone", "its kernels use one column only", suggestion);
    if (s.packed)
        throw InputError("--device cuda with --packed", "its kernels read plain layers only", suggestion);
    if (own.interleave > 1)
        throw InputError("--device cuda with --interleave", "its kernels compute indirect light in all pixels",
                         suggestion);
    if (own.cache == RadianceCaching::on && settings.of<PathAlgorithm>().surfaces != SurfacesBy::rays)
        throw InputError("--method slhb --device cuda with --radiance-cache on",
                         "the kernels of slhb do not end paths in a cache", suggestion);
    if (s.gather) throw InputError("--device cuda with --gather", "its kernels choose axes at random", suggestion);
}

template <Space S>
KernelRenderer<S>::KernelRenderer(World const& world, std::span<FrameView const> views,
                                  RenderSettings const& settings, TriangleSoup soup, std::size_t first_moving,
                                  Report& report, FirstSurfaces first_surfaces)
    : world_(world),
      settings_(settings),
      report_(report),
      traced_(world, std::move(soup), first_moving, slhb_),
      scene_(world, traced_.soup, traced_.cut_outs, std::uint32_t(slhb_.most_layers)),
      axes_(slhb_, report),
      first_surfaces_(first_surfaces)
{
    see(views);
    end_frame();
    build_exact();
    make_axes();
    make_light_points();
    if (free() && settings_.of<PathsSettings>().cache != RadianceCaching::off && settings_.bounces > 0)
        scene_.use_cache(world.bounds.radius(), std::size_t(slhb_.memory_mib) << 20, pixels());
}

template <Space S>
void KernelRenderer<S>::build_exact()
{
    bool const needed = free() || narrow_somewhere(world_) || slhb_.confirm == Confirming::on;
    if (needed && scene_.has_rays()) return scene_.test_alpha(plan_scene(world_).alpha_tests);
    if (needed == scene_.has_rays()) return;
    StageTimer const timer(report_, "build (BVH)");
    scene_.use_rays(needed, plan_scene(world_).alpha_tests, traced_.first_moving);
    finish(S);
}

template <Space S>
void KernelRenderer<S>::make_axes()
{
    scene_.forget_axes();
    auto const build = [this](std::span<AxisSet::AxisToBuild const> axes) {
        try {
            auto built = scene_.build_axes(axes);
            finish(S); // so that their time is known, by which fewer are updated
            return built;
        } catch (std::bad_alloc const&) { // a device has less memory than --memory says
            throw HitBuffersTooLarge();
        }
    };
    axes_.make({.bounds = traced_.grid_bounds,
                .windows = traced_.windows.boxes(),
                .soup = traced_.soup,
                .cut_outs = traced_.cut_outs,
                .resolution = std::uint32_t(slhb_.resolution),
                .most_layers = std::uint32_t(slhb_.most_layers),
                .packed = false,
                .seed = settings_.seed,
                .elsewhere = build,
                .most_bytes = std::size_t(slhb_.memory_mib) << 20,
                .first_moving = traced_.first_moving},
               walks());
}

template <Space S>
void KernelRenderer<S>::make_light_points()
{
    if (light_points_) earlier_maps_ += light_points_->maps_built();
    scene_.forget_light_points();
    light_points_.emplace(world_, traced_.grid_bounds, traced_.soup, traced_.cut_outs,
                          LightPointSettings{.count = std::uint32_t(free() ? 0 : slhb_.light_samples),
                                             .fresh = std::uint32_t(slhb_.fresh_light_samples),
                                             .resolution = std::uint32_t(slhb_.shadow_resolution),
                                             .windows = traced_.windows.boxes(),
                                             .seed = settings_.seed,
                                             .first_moving = traced_.first_moving},
                          [this](LightPoints::DeviceDraw const& now) { scene_.draw_light_points(now); });
}

template <Space S>
void KernelRenderer<S>::changed(Changes const& c)
{
    if (c.geometry || c.materials || c.coverage || c.lights || c.emitters || c.environment || c.light_select)
        forget();
    {
        StageTimer const timer(report_, "update of dynamic triangles");
        if (c.geometry) traced_.move(world_);
        scene_.update(world_, traced_.soup, c);
        finish(S);
    }
    if (c.materials || c.coverage) build_exact();
    bool axes = axes_.walks() != walks(), light_points = changes_lights(c);
    if (c.geometry) {
        if (traced_.outgrown(world_, slhb_.schedule, report_)) {
            traced_.place_windows(views_);
            axes = light_points = true; // the maps of parallel lights depend on the same bounds
        }
        axes_.set().moved();
        light_points_->moved();
    }
    if (axes) make_axes();
    if (light_points) make_light_points();
}

template <Space S>
void KernelRenderer<S>::end_frame()
{
    axes_.end_frame();
    traced_.end_frame();
    for (View& v : views_) v.earlier = v.rays;
}

template <Space S>
void KernelRenderer<S>::see(std::span<FrameView const> views)
{
    for (FrameView const& v : views) check(v.camera, settings_);
    views_.resize(views.size());
    for (std::size_t k = 0; k < views.size(); ++k) {
        FrameView const& now = views[k];
        View& v = views_[k];
        v.follow(now, world_.origin, settings_.filter);
        if (std::ranges::equal(v.hides, now.hidden)) continue;
        v.hides.assign(now.hidden.begin(), now.hidden.end());
        v.hidden = upload<S>(v.hides);
    }
    if (!free() && traced_.place_windows(views_) && light_points_) {
        make_axes();
        make_light_points();
    }
}

template <Space S>
void KernelRenderer<S>::prepare(std::uint32_t index)
{
    axes_.prepare(settings_.bounces + (meets_light(world_) ? 1 : 0), index);
    {
        StageTimer const timer(report_, "shadow maps");
        light_points_->refresh(index);
        finish(S);
    }
    if (free()) {
        light_order_.update(world_);
        lights_.fill(light_order_, world_, LightPool::groups_for(pixels(), world_), settings_.seed, index);
        scene_.take_pool(lights_);
    }
    if (first_surfaces_ == FirstSurfaces::by_rays) return;
    StageTimer const timer(report_, "G-buffer");
    std::vector<PerspectiveGrid> grids;
    for (View& v : views_) {
        v.eye = eye_of_pass(v.rays, settings_.seed, index);
        v.index = index;
        grids.push_back(camera_grid(v.eye, v.width, v.height, place_in_pixel(v.filter, settings_.seed, index),
                                    near_plane(world_.bounds)));
    }
    auto drawn = scene_.draw(grids, std::uint32_t(mix_bits(settings_.seed) + index));
    for (std::size_t k = 0; k < views_.size(); ++k) views_[k].primary = std::move(drawn[k]);
    finish(S);
}

template <Space S>
void KernelRenderer<S>::passes(std::uint32_t index, std::uint32_t count, std::span<Accumulator> sums,
                               VertexSharing sharing, StopRequest const* stop)
{
    for (std::size_t k = 0; k < views_.size(); ++k) views_[k].sums.take(sums[k]);
    for (std::uint32_t i = 0; i < count && !(i > 0 && stop && stop->requested()); ++i)
        add_pass(index + i, sums, sharing == VertexSharing::cached);
    StageTimer const timer(report_, "paths");
    PathKernelCounts const done = scene_.take_counts();
    sums[0].counts.cut_paths += done.cut_paths; // of all views, which are reported together
    sums[0].counts.invalid_paths += done.invalid_paths;
    queries_ += done.queries;
    exact_rays_ += done.exact_rays;
    shadow_lookups_ += done.shadow_lookups;
    shadow_rays_ += done.shadow_rays;
    cache_reads_ += done.cache_reads;
    doubtful_queries_ += done.doubtful_queries;
    doubtful_shadows_ += done.doubtful_shadows;
    for (std::size_t k = 0; k < views_.size(); ++k) views_[k].sums.give(sums[k], sums[k].paths);
}

template <Space S>
void KernelRenderer<S>::add_pass(std::uint32_t index, std::span<Accumulator> sums, bool cached)
{
    prepare(index);
    StageTimer const timer(report_, "paths");
    bool const smooth = smooth_somewhere(world_);
    if (!free())
        scene_.start_pass(axes_.set(), light_points_->fixed() ? light_points_->chances() : AliasTableView{});
    for (std::size_t k = 0; k < views_.size(); ++k) {
        View& v = views_[k];
        Accumulator& to = sums[k];
        PassOfPaths paths{};
        paths.camera = first_surfaces_ == FirstSurfaces::by_rays ? v.rays : v.eye;
        paths.primary = std::as_const(v.primary).view();
        paths.hidden = std::as_const(v.hidden).view();
        paths.place = place_in_pixel(v.filter, settings_.seed, index);
        paths.filter = v.filter;
        paths.pixels = v.pixels();
        paths.width = std::uint32_t(v.width);
        paths.bounces = settings_.bounces;
        paths.smooth = smooth;
        paths.meets_light = meets_light(world_);
        paths.confirms = !free() && slhb_.confirm == Confirming::on;
        paths.roulette = settings_.of<PathsSettings>().roulette;
        paths.seed = random_key(settings_.seed);
        paths.pass = index;
        v.sums.add(scene_.trace(paths, free(), cached));
        ++to.paths;
        hidden_ += v.hidden_pixels;
        pixels_ += v.pixels();
    }
    if (scene_.cache() != nullptr) {
        scene_.cache()->end_pass();
        if (cached)
            scene_.cache()->grow(); // after every pass: whatever the number of passes together, the same bits
    }
    finish(S);
}

template <Space S>
void KernelRenderer<S>::add_motion(std::size_t view, Picture& picture) const
{
    View const& v = views_[view];
    PrimaryMap map(traced_.soup, traced_.cut_outs, settings_, v.width, v.height);
    map.set_filter(v.filter);
    map.take(v.eye, v.index, download(v.primary));
    gi::add_motion(map, traced_.soup, v.rays, v.earlier, traced_.earlier, picture);
}

template <Space S>
void KernelRenderer<S>::report_work()
{
    report_.count("exact rays", double(exact_rays_));
    if (free()) {
        report_.count("shadow rays", double(shadow_rays_));
        if (scene_.cache() != nullptr) {
            report_.count("paths that ended in the radiance cache", double(cache_reads_));
            report_.count("cells of the radiance cache", double(scene_.cache()->cells()));
            report_.count("bytes of the radiance cache", double(scene_.cache()->bytes()));
        }
    } else {
        report_.count("hit-buffer queries", double(queries_));
        report_.count("shadow-map look-ups", double(shadow_lookups_));
    }
    if (!free() && slhb_.confirm == Confirming::on) {
        report_.count("doubtful look-ups decided by exact rays", double(doubtful_queries_));
        report_.count("doubtful shadow-map look-ups decided by exact rays", double(doubtful_shadows_));
    }
    if (hidden_ > 0) {
        report_.count("pixels not rendered, as nobody sees them", double(hidden_));
        report_.count("share of pixels not rendered", double(hidden_) / double(pixels_));
    }
    axes_.report_work();
    report_.count("shadow maps built", double(earlier_maps_ + light_points_->maps_built()));
}

template class KernelRenderer<Space::host>;
template class KernelRenderer<Space::device>;

} // namespace gi
