#include "gi/methods/photons/splat.h"

#include "gi/kernel/launch.h"
#include "gi/kernel/scan.h"

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

PhotonTiles::PhotonTiles(ScreenMap const& screen, View<PhotonKernel const> kernels, View<Photon const> photons)
    : screen_(screen), kernels_(kernels), photons_(photons)
{
    std::size_t const tiles = std::size_t(screen.columns()) * std::size_t(screen.rows());
    std::vector<std::uint32_t> counts(tiles + 1);
    launch(Space::host, "count tiles", kernels.size(), CountTiles{screen, kernels, counts});
    exclusive_scan(Space::host, {counts.data(), counts.size()}, counts);
    list_.resize(counts.back());
    launch(Space::host, "fill tiles", kernels.size(), FillTiles{screen, kernels, counts, list_});
    counts.pop_back();
    ends_ = std::move(counts);
    launch(Space::host, "sort tiles", tiles, SortTiles{ends_, list_});
}

} // namespace gi
