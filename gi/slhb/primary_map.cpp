#include "gi/slhb/primary_map.h"

#include "gi/transport/pass_samples.h"
#include "gi/transport/sampling.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace gi {

vec2 place_in_pixel(PixelFilter filter, std::uint64_t seed, std::uint32_t pass)
{
    return 0.5f + filter_offset(filter, sample_in_pixel(seed, pass));
}

PrimaryMap::PrimaryMap(TriangleSoup const& soup, CutOuts const& cut_outs, RenderSettings const& settings,
                       int width, int height)
    : soup_(soup),
      cut_outs_(cut_outs),
      width_(width),
      height_(height),
      filter_(settings.filter),
      seed_(settings.seed)
{
}

PerspectiveGrid PrimaryMap::start(CameraRays const& camera, float near_m, std::uint32_t pass)
{
    camera_ = camera;
    at_ = place_in_pixel(filter_, seed_, pass);
    clear(map_, std::uint32_t(width_), std::uint32_t(height_));
    return camera_grid(camera_, width_, height_, at_, near_m);
}

void PrimaryMap::refresh(CameraRays const& camera, float near_m, std::uint32_t pass)
{
    draw(start(camera, near_m, pass), 0, soup_.count, pass);
}

void PrimaryMap::refresh_pair(CameraRays const& camera, float near_m, std::uint32_t pass, std::size_t first_moving)
{
    PerspectiveGrid const grid = start(camera, near_m, pass);
    std::size_t const first = std::min(first_moving, soup_.count);
    draw(grid, 0, first, pass);
    behind_ = map_;
    draw(grid, first, soup_.count, pass);
}

void PrimaryMap::draw(PerspectiveGrid const& grid, std::size_t first, std::size_t last, std::uint32_t pass)
{
    constexpr std::size_t kPart = 32 * TriangleSoup::kChunk;
    tbb::parallel_for(std::size_t(0), (last - first + kPart - 1) / kPart, [&](std::size_t k) {
        thread_local Fragments fragments;
        fragments.count = 0;
        rasterize(soup_, first + k * kPart, std::min(last, first + (k + 1) * kPart), grid, fragments);
        cut_outs_.remove(fragments, grid, std::uint32_t(mix_bits(seed_) + pass));
        resolve(fragments, 1, map_);
    });
}

void PrimaryMap::hits(std::size_t first, std::size_t last, std::vector<PathStart>& out) const
{
    out.clear();
    for (std::size_t p = first; p < last; ++p) out.push_back(hit(map_, p));
}

void PrimaryMap::hits_behind(std::span<std::uint32_t const> pixels, std::vector<PathStart>& out) const
{
    out.clear();
    for (std::uint32_t const p : pixels) out.push_back(hit(behind_, p));
}

PathStart PrimaryMap::hit(NearestMap const& map, std::size_t pixel) const
{
    vec2 const place{float(pixel % std::size_t(width_)), float(pixel / std::size_t(width_))};
    return {std::uint32_t(pixel), map.texels[pixel].primitive, camera_.through(place + at_)};
}

std::optional<std::size_t> PrimaryMap::pixel_near(vec3 point) const
{
    vec3 const at = project(camera_, point);
    float const x = std::floor(at.x - at_.x + 0.5f), y = std::floor(at.y - at_.y + 0.5f);
    if (!(at.z > 0 && x >= 0 && y >= 0 && x < float(width_) && y < float(height_))) return std::nullopt;
    return std::size_t(y) * std::size_t(width_) + std::size_t(x);
}

} // namespace gi
