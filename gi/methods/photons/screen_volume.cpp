#include "gi/methods/photons/screen_volume.h"

#include "gi/kernel/stoppable_launch.h"
#include "gi/methods/photons/lattice_kernels.h"
#include "gi/methods/photons/splat.h"
#include "gi/render/sampling.h"

#include <algorithm>

namespace gi {

void ScreenVolume::place(World const& world, TriangleSoup const& soup, CutOuts const& cut_outs, FrameView const& v,
                         std::uint32_t seed)
{
    screen_ = screen_map(v, world.origin);
    CameraRays const camera = camera_rays(v.camera, v.width, v.height, world.origin);
    PerspectiveGrid const grid =
        camera_grid(camera, v.width, v.height, {0.5f, 0.5f}, camera_clearance(camera.origin));
    Fragments fragments;
    NearestMap seen;
    clear(seen, grid.width, grid.height);
    rasterize(soup, 0, soup.count, grid, fragments);
    cut_outs.remove(fragments, grid, seed);
    resolve(fragments, 1, seen);
    surfaces_.resize(grid.texels());
    launch(Space::host, "find surfaces on screen", surfaces_.size(),
           FindScreenSurfaces{grid, gi::view(world), seen.texels, surfaces_});
    light_.assign(surfaces_.size(), {});
}

void ScreenVolume::update(std::span<Photon const> photons, BuildStop const& stop)
{
    std::size_t const pixels = surfaces_.size();
    injected_w_ = lost_w_ = dvec3{0};
    light_.assign(pixels, {});
    std::vector<ScreenPhoton> items(photons.size());
    std::vector<std::uint64_t> keys(photons.size());
    launch_host(photons.size(),
                FindPhotonPixels{screen_, surfaces_, {photons.data(), photons.size()}, items, keys}, stop);
    for (std::size_t k = 0; k < items.size(); ++k)
        if (all_finite(items[k].flux)) (keys[k] < pixels ? injected_w_ : lost_w_) += dvec3(items[k].flux);
    ItemsByCell const sorted = sort_by_cell(keys, pixels);
    launch_host(pixels, SumItems<ScreenPhoton, ShColor>{items, sorted.order, sorted.firsts, light_}, stop);
    std::vector<ShColor> next(settings_.gathers > 0 ? pixels : 0);
    for (int step = 0; step < settings_.gathers; ++step) {
        launch_host(pixels, GatherScreen{screen_.size, surfaces_, light_, next}, stop);
        std::swap(light_, next);
    }
}

} // namespace gi
