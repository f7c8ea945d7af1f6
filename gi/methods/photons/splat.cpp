#include "gi/methods/photons/splat.h"

#include "gi/kernel/scan.h"
#include "gi/kernel/stoppable_launch.h"

#include <numeric>
#include <stdexcept>
#include <tbb/parallel_reduce.h>

namespace gi {

ScreenMap screen_map(FrameView const& v, dvec3 world_origin)
{
    CameraRays const rays = camera_rays(v.camera, v.width, v.height, world_origin);
    ScreenMap out{rays.origin, mat3{1}, rays.orthographic, {v.width, v.height}};
    // In metres of the scene determinants of small pixels would underflow.
    glm::dmat3 const from{dvec3(rays.step_x), dvec3(rays.step_y),
                          dvec3(rays.orthographic ? rays.forward : rays.corner)};
    out.to = mat3(glm::inverse(from));
    if (rays.orthographic) out.origin += rays.corner;
    return out;
}

std::uint64_t tile_entries(ScreenMap const& screen, View<PhotonKernel const> kernels)
{
    using Range = tbb::blocked_range<std::size_t>;
    return tbb::parallel_reduce(
        Range(0, kernels.size()), std::uint64_t(0),
        [&](Range const& range, std::uint64_t sum) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                TileRange const r = tiles_of(screen, kernels[i].position, kernels[i].radius);
                glm::ivec2 const tiles = glm::max(r.last - r.first, glm::ivec2{0});
                sum += std::uint64_t(tiles.x) * std::uint64_t(tiles.y);
            }
            return sum;
        },
        std::plus<>());
}

PhotonTiles::PhotonTiles(ScreenMap const& screen, View<PhotonKernel const> kernels, View<Photon const> photons,
                         BuildStop const& stop)
    : screen_(screen), kernels_(kernels), photons_(photons)
{
    std::size_t const tiles = std::size_t(screen.columns()) * std::size_t(screen.rows());
    std::vector<std::uint32_t> counts(tiles + 1);
    launch_host(kernels.size(), CountTiles{screen, kernels, counts}, stop);
    if (std::accumulate(counts.begin(), counts.end(), std::uint64_t(0)) > kMostEntries)
        throw std::length_error("PhotonTiles: more entries than lists can have");
    exclusive_scan(Space::host, {counts.data(), counts.size()}, counts);
    list_.resize(counts.back());
    launch_host(kernels.size(), FillTiles{screen, kernels, counts, list_}, stop);
    counts.pop_back();
    ends_ = std::move(counts);
    launch_host(tiles, SortTiles{ends_, list_}, stop);
}

std::vector<PhotonTiles> tiles_of_views(std::span<FrameView const> views, dvec3 world_origin,
                                        View<PhotonKernel const> kernels, View<Photon const> photons,
                                        BuildStop const& stop)
{
    std::uint64_t entries = 0;
    for (FrameView const& v : views) entries += tile_entries(screen_map(v, world_origin), kernels);
    std::vector<PhotonTiles> out;
    if (entries > PhotonTiles::kMostEntries) return out;
    for (FrameView const& v : views) out.emplace_back(screen_map(v, world_origin), kernels, photons, stop);
    return out;
}

} // namespace gi
