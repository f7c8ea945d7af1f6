#include "gi/methods/photons/splat_light.h"

#include "gi/methods/whitted/caustic_light.h"

#include <algorithm>

namespace gi {
namespace {

constexpr int kBlock = 4; ///< px; points that are this near on screen share a list of photons

} // namespace

void SplatLight::indirect(std::span<TreePoint> points, std::span<vec3> out, PathCounts&) const
{
    if (caustics_ != nullptr) add_caustics(*caustics_, points);
    std::vector<Place> places;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        std::optional<Place> const place = find_place(points[i], i);
        if (place)
            places.push_back(*place);
        else
            out[i] =
                points[i].wo.z > 0 ? map_.radiance(points[i].at, points[i].wo, points[i].glossy_traced) : vec3{0};
    }
    std::ranges::sort(places, {}, &Place::block);
    for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
        while (end < places.size() && places[end].block == places[begin].block) ++end;
        splat_block(points, std::span(places).subspan(begin, end - begin), out);
    }
}

std::optional<SplatLight::Place> SplatLight::find_place(TreePoint const& p, std::uint32_t i) const
{
    if (!(p.wo.z > 0)) return {};
    for (std::uint32_t k = 0; k < screens_.size(); ++k) {
        ScreenMap const& screen = screens_[k].view().screen;
        glm::ivec2 const pixel = screen.pixel_of(p.at.position);
        if (pixel.x < 0) continue;
        std::uint64_t const x = std::uint64_t(pixel.x / kBlock), y = std::uint64_t(pixel.y / kBlock);
        return Place{std::uint64_t(k) << 48 | y << 24 | x, i, k, std::uint32_t(screen.tile_of(pixel))};
    }
    return {};
}

/// Of the tile's photons only those that reach the block are tested against each of its points.
void SplatLight::splat_block(std::span<TreePoint const> points, std::span<Place const> places,
                             std::span<vec3> out) const
{
    TilesView const tiles = screens_[places[0].screen].view();
    vec3 low{kInf}, high{-kInf};
    for (Place const& p : places) {
        low = glm::min(low, points[p.point].at.position);
        high = glm::max(high, points[p.point].at.position);
    }
    thread_local std::vector<PhotonKernel> near;
    near.clear();
    for (std::uint32_t const k : tiles.of_tile(places[0].tile)) {
        PhotonKernel const& kernel = tiles.kernels[k];
        vec3 const way = kernel.position - glm::clamp(kernel.position, low, high);
        if (glm::dot(way, way) < square(kernel.radius)) near.push_back(kernel);
    }
    for (Place const& p : places) {
        TreePoint const& point = points[p.point];
        PhotonSum sum(point.at, point.wo, point.glossy_traced);
        for (PhotonKernel const& kernel : near) sum.add(kernel, tiles.photons[kernel.photon]);
        out[p.point] = sum.radiance();
    }
}

} // namespace gi
