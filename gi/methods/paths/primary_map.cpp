#include "gi/methods/paths/primary_map.h"

#include "gi/render/pass_samples.h"
#include "gi/render/sampling.h"

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
      seed_(settings.seed),
      projection_(camera_)
{
}

void PrimaryMap::look_through(CameraRays const& camera, std::uint32_t pass)
{
    camera_ = camera;
    projection_ = Projection(camera);
    at_ = place_in_pixel(filter_, seed_, pass);
}

void PrimaryMap::take(CameraRays const& camera, std::uint32_t pass, std::vector<NearestTexel> texels)
{
    look_through(camera, pass);
    map_ = {std::uint32_t(width_), std::uint32_t(height_), std::move(texels)};
}

PerspectiveGrid PrimaryMap::start(CameraRays const& camera, float near_m, std::uint32_t pass)
{
    look_through(camera, pass);
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
    draw_view(soup_, first, last, cut_outs_, grid, std::uint32_t(mix_bits(seed_) + pass), map_);
}

void PrimaryMap::hits(std::size_t first, std::size_t last, std::vector<PathStart>& out) const
{
    out.resize(last - first);
    if (out.empty()) return;
    std::size_t x = first % std::size_t(width_), y = first / std::size_t(width_);
    for (std::size_t p = first; p < last; ++p) {
        out[p - first] = hit(map_, x, y);
        if (++x == std::size_t(width_)) x = 0, ++y;
    }
}

void PrimaryMap::hits_behind(std::span<std::uint32_t const> pixels, std::vector<PathStart>& out) const
{
    out.clear();
    for (std::uint32_t const p : pixels)
        out.push_back(hit(behind_, p % std::size_t(width_), p / std::size_t(width_)));
}

PathStart PrimaryMap::hit(NearestMap const& map, std::size_t x, std::size_t y) const
{
    std::size_t const pixel = y * std::size_t(width_) + x;
    return {std::uint32_t(pixel), map.texels[pixel].primitive, camera_.through(vec2{float(x), float(y)} + at_)};
}

std::optional<std::size_t> PrimaryMap::pixel_near(vec3 point) const
{
    vec3 const at = projection_(point);
    float const x = std::floor(at.x - at_.x + 0.5f), y = std::floor(at.y - at_.y + 0.5f);
    if (!(at.z > 0 && x >= 0 && y >= 0 && x < float(width_) && y < float(height_))) return std::nullopt;
    return std::size_t(y) * std::size_t(width_) + std::size_t(x);
}

} // namespace gi
