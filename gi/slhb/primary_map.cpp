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

void PrimaryMap::refresh(CameraRays const& camera, float near_m, std::uint32_t pass)
{
    camera_ = camera;
    at_ = place_in_pixel(filter_, seed_, pass);
    PerspectiveGrid const grid = camera_grid(camera_, width_, height_, at_, near_m);
    clear(map_, std::uint32_t(width_), std::uint32_t(height_));
    constexpr std::size_t kPart = 32 * TriangleSoup::kChunk;
    tbb::parallel_for(std::size_t(0), (soup_.count + kPart - 1) / kPart, [&](std::size_t k) {
        thread_local Fragments fragments;
        fragments.count = 0;
        rasterize(soup_, k * kPart, std::min(soup_.count, (k + 1) * kPart), grid, fragments);
        cut_outs_.remove(fragments, grid, std::uint32_t(mix_bits(seed_) + pass));
        resolve(fragments, 1, map_);
    });
}

void PrimaryMap::hits(std::size_t first, std::size_t last, std::vector<PathStart>& out) const
{
    out.clear();
    for (std::size_t p = first; p < last; ++p) {
        vec2 const place{float(p % std::size_t(width_)), float(p / std::size_t(width_))};
        out.push_back({std::uint32_t(p), map_.texels[p].primitive, camera_.through(place + at_)});
    }
}

std::optional<std::size_t> PrimaryMap::pixel_near(vec3 point) const
{
    vec3 const at = project(camera_, point);
    float const x = std::floor(at.x - at_.x + 0.5f), y = std::floor(at.y - at_.y + 0.5f);
    if (!(at.z > 0 && x >= 0 && y >= 0 && x < float(width_) && y < float(height_))) return std::nullopt;
    return std::size_t(y) * std::size_t(width_) + std::size_t(x);
}

} // namespace gi
