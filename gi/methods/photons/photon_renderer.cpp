#include "gi/methods/photons/photon_renderer.h"

#include "gi/light_paths/bounce_map.h"
#include "gi/light_paths/focus.h"
#include "gi/light_paths/memory_limit.h"
#include "gi/light_paths/options.h"
#include "gi/methods/photons/limits.h"

#include <algorithm>

namespace gi {

vec3 camera_of(std::span<FrameView const> views, World const& world)
{
    return views.empty() ? world.bounds.center()
                         : vec3(dvec3(views[0].camera.world_from_camera[3]) - world.origin);
}

bool same_pictures(std::span<FrameView const> a, std::span<FrameView const> b)
{
    return std::ranges::equal(a, b, [](FrameView const& v, FrameView const& w) {
        return v.camera == w.camera && v.width == w.width && v.height == w.height;
    });
}

PhotonRenderer::PhotonRenderer(World const& world, RenderSettings const& settings, std::size_t first_moving,
                               Report& report, StopRequest const* stop)
    : TreeRenderer(world, settings, first_moving, report, stop),
      frames_(stop == nullptr),
      caustics_(world, settings, report),
      light_rays_(world, settings, first_moving, report, stop),
      paths_(std::uint32_t(settings.of<PhotonSettings>().paths))
{
}

void PhotonRenderer::changed(Changes const& c)
{
    TreeRenderer::changed(c);
    caustics_.changed(c);
    surfaces_changed_ = surfaces_changed_ || c.geometry || c.bounds || c.materials || c.coverage;
    more_than_moved_ = more_than_moved_ || c.materials || c.coverage;
    soup_moved_ = soup_moved_ || c.geometry;
    light_rays_.changed(c);
    light_changed_ = light_changed_ || c.lights || c.emitters || c.environment;
}

SurfaceLight const* PhotonRenderer::prepare(std::uint32_t index, std::span<FrameView const> views,
                                            StopRequest const* stop)
{
    PathCounts counts;
    if (!first_index_) first_index_ = index;
    bool const any = !world_.light_select.empty() && !world_.bounds.empty(),
               frozen = settings_.of<PhotonSettings>().frozen == Switch::on;
    if (any && !(frozen && has_light_)) find_focus(views);
    if (any && settings_.bounces > 0) update(index, views, BuildStop(stop), counts);
    BuildStop const given_up(stop);
    if (any && has_caustics() && !(frozen && caustics_known_)) {
        caustics_.prepare(*visibility_, index, views, focus_, share(), given_up, counts);
        caustics_known_ = true;
    }
    rays_ += double(counts.nearest_rays + counts.shadow_rays);
    work_.paths += counts;
    return any || (frozen && has_light_) ? light(views, caustics_.map(), given_up) : nullptr;
}

/// A room in a large world gets half of the light from afar. It is kept while it holds most of what the cameras
/// show, because a new one discards all light so far.
void PhotonRenderer::find_focus(std::span<FrameView const> views)
{
    constexpr int kCells = 64;
    constexpr double kLeastShown = 0.9;
    bool const moved = surfaces_changed_ || !std::ranges::equal(views, cameras_, {}, &FrameView::camera);
    if (!moved) return;
    std::vector<vec3> const points = shown_points(world_, *visibility_, views);
    if (points.empty()) return;
    if (!focus_.empty() && share_in(focus_, points) >= kLeastShown && holds(world_.bounds, focus_)) return;
    Bounds const focus = focus_in(world_.bounds, points, kCells);
    if (focus.empty() && focus_.empty()) return;
    focus_ = focus;
    surfaces_changed_ = true;
}

/// Lattices around the camera are kept until it has moved by an eighth of the finest one's side,
/// because moving them discards all light so far.
void PhotonRenderer::find_middle(std::span<FrameView const> views)
{
    constexpr float kShare = 0.125f;
    vec3 const camera = camera_of(views, world_);
    float const finest = std::ldexp(longest_side(world_.bounds), 1 - std::max(cascades_about_camera(), 1));
    if (middle_ && (cascades_about_camera() < 2 || max_component(glm::abs(camera - *middle_)) < kShare * finest))
        return;
    middle_ = camera;
    middle_changed_ = true;
}

void PhotonRenderer::update(std::uint32_t index, std::span<FrameView const> views, BuildStop const& stop,
                            PathCounts& counts)
{
    if (settings_.of<PhotonSettings>().frozen == Switch::on && has_light_) return;
    bool const new_cameras = !std::ranges::equal(views, cameras_, {}, &FrameView::camera);
    cameras_.clear();
    for (FrameView const& v : views) cameras_.push_back(v.camera);
    find_middle(views);
    bool const fresh = light_changed_ || surfaces_changed_ || middle_changed_;
    if (fresh || (new_cameras && sets_ > 1))
        sets_ = 0;
    else if (new_cameras && has_light_)
        return;
    try {
        if (!has_light_ && settings_.budget_s > 0)
            fit_budget(views, stop, counts);
        else
            trace_set(views, stop, counts);
    } catch (Interrupted const&) {
        // If the first pass is stopped, the light of the small sets traced so far is used.
        if (!has_light_ || frames() || index != *first_index_) throw;
    }
}

/// Finds from a small set how large one may be: some fit into a picture's budget, one into a frame's.
void PhotonRenderer::fit_budget(std::span<FrameView const> views, BuildStop const& stop, PathCounts& counts)
{
    std::uint32_t const asked = paths_;
    paths_ = std::clamp(asked / 64, 1u, 4096u);
    trace_set(views, stop, counts); // also builds what is built once
    sets_ = 0;
    auto const begun = Clock::now();
    trace_set(views, stop, counts);
    double const took_s = std::chrono::duration<double>(Clock::now() - begun).count();
    double const most_s = settings_.budget_s / (frames() ? 3 : 8);
    paths_ = std::uint32_t(std::clamp(double(paths_) * most_s / took_s, double(paths_), double(asked)));
    sets_ = 0;
    trace_set(views, stop, counts);
}

void PhotonRenderer::trace_set(std::span<FrameView const> views, BuildStop const& stop, PathCounts& counts)
{
    constexpr std::uint32_t kTogether = 1 << 16; // bounds the memory of vertices
    std::vector<Photon> photons;
    auto const keep = [&](std::span<LightVertex const> vertices, double share) {
        for (LightVertex const& v : vertices)
            if (stores(v)) photons.push_back(to_photon(v));
        double const expected = double(photons.size()) / share;
        check_bytes(std::uint64_t(expected * double(bytes_per_photon())), "photons",
                    "choose fewer --photons or --reflections");
        // Copies of gigabytes, as the array grows, could not be stopped.
        if (expected > double(photons.capacity())) photons.reserve(std::size_t(1.05 * expected));
    };
    {
        PathRays const& rays = light_rays_.of(rays_kind(), *visibility_, focus_);
        StageTimer const timer(report_, "light paths");
        bool const by_map = settings_.of<PhotonSettings>().first_bounce == FirstBounce::map;
        if (by_map) {
            if (!soup_)
                soup_ = make_soup(world_);
            else if (soup_moved_)
                update_soup(world_, first_moving_, *soup_);
            soup_moved_ = false;
        }
        for (std::uint32_t first = 0; first < paths_; first += kTogether) {
            LightPaths const some{.count = paths_,
                                  .first = first,
                                  .last = std::min(paths_ - first, kTogether) + first,
                                  .bounces = bounces() + 1,
                                  .seed = settings_.seed,
                                  .pass = *first_index_ + sets_,
                                  .focus = focus_,
                                  .stop = &stop};
            if (by_map) {
                trace_bounce_maps(view(world_), world_.bounds, *soup_, CutOuts(world_), rays, some, counts, keep);
                break; // the whole set
            }
            keep(trace_light_paths(view(world_), world_.bounds, rays, some, counts), double(some.last) / paths_);
        }
    }
    has_light_ = false;
    stored_ = photons.size();
    flux_ = dvec3{0};
    for (Photon const& p : photons) flux_ += dvec3(p.flux);
    {
        StageTimer const timer(report_, std::string(timer_name()));
        take({std::move(photons), sets_, paths_, surfaces_changed_, !more_than_moved_, focus_, *middle_,
              middle_changed_, *visibility_, views, stop, counts});
    }
    ++sets_;
    light_changed_ = surfaces_changed_ = more_than_moved_ = middle_changed_ = false;
    has_light_ = true;
}

void PhotonRenderer::report_work()
{
    TreeRenderer::report_work();
    if (has_light_ || sets_ > 0) {
        report_.count("light paths of a set of photons", double(paths_));
        report_.count("photons of the last set", double(stored_));
        report_.count("sets of photons since the last change", double(sets_));
        report_.count("flux of the photons, W (luminance)", double(luminance(vec3(flux_))));
    }
    light_rays_.report_counts();
    report_light(report_);
    caustics_.report_counts();
}

std::string PhotonRenderer::asked_options() const
{
    return TreeRenderer::options() + " " + changed_options(photon_options(), settings_, {}) +
           light_rays_.options(rays_kind());
}

std::string PhotonRenderer::options() const
{
    RenderSettings chosen = settings_;
    chosen.of<PhotonSettings>().paths = int(paths_);
    chosen.of<PhotonSettings>().caustic_paths = int(share() * chosen.of<PhotonSettings>().caustic_paths);
    std::vector<std::string_view> names{"photons"};
    if (has_caustics()) names.push_back("caustic-photons");
    return TreeRenderer::options() + " " + changed_options(photon_options(), chosen, names) +
           light_rays_.options(rays_kind());
}

} // namespace gi
