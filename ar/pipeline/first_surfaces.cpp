#include "ar/pipeline/first_surfaces.h"

#include "gi/scene/shading/texture_lookup.h"

#include <stdexcept>
#include <tbb/parallel_for.h>

namespace ar {
namespace {

/// Triangles first..end - 1 have no area any more, and are nowhere but at one point.
void leave_out(gi::TriangleSoup& soup, std::size_t first, std::size_t end, gi::vec3 at)
{
    for (std::size_t k = 0; k < 9; ++k)
        std::fill(soup.corner[k].begin() + std::ptrdiff_t(first), soup.corner[k].begin() + std::ptrdiff_t(end),
                  at[glm::length_t(k % 3)]);
    for (std::size_t c = 0; c < soup.chunks.size(); ++c) {
        std::size_t const begin = c * gi::TriangleSoup::kChunk;
        if (begin >= first && std::min(begin + gi::TriangleSoup::kChunk, soup.count) <= end)
            soup.chunks[c] = {at, at};
    }
}

} // namespace

SurfaceView::SurfaceView(gi::World const& world, Surfaces surfaces)
    : world_(world), surfaces_(surfaces), soup_(gi::make_soup(world)), cut_outs_(world)
{
    hide();
}

void SurfaceView::moved()
{
    gi::update_soup(world_, world_.static_triangles, soup_);
    hide();
}

void SurfaceView::hide()
{
    if (soup_.count == 0) return;
    gi::vec3 const at = world_.bounds.empty() ? gi::vec3(0) : world_.bounds.center();
    if (surfaces_ == Surfaces::still) leave_out(soup_, world_.static_triangles, soup_.count, at);
    if (surfaces_ == Surfaces::moving) leave_out(soup_, 0, world_.static_triangles, at);
}

FirstSurfaces SurfaceView::seen(gi::Camera const& camera, int width, int height, std::uint32_t pass,
                                cv::Rect region, Surfaces wanted) const
{
    if (region.empty()) region = {0, 0, width, height};
    if (camera.orthographic) throw std::invalid_argument("first surfaces of an orthographic camera");
    gi::RenderSettings const settings;
    gi::PrimaryMap map(soup_, cut_outs_, settings, width, height);
    gi::CameraRays const rays = gi::camera_rays(camera, width, height, world_.origin);
    map.refresh(rays, gi::near_plane(world_.bounds), pass);
    FirstSurfaces s{
        cv::Mat(height, width, CV_32SC1, cv::Scalar(-1)), cv::Mat(height, width, CV_32FC1, cv::Scalar(0)),
        cv::Mat(height, width, CV_32FC3, cv::Scalar::all(0)), cv::Mat(height, width, CV_32FC3, cv::Scalar::all(0)),
        cv::Mat(height, width, CV_32FC2, cv::Scalar::all(0))};
    gi::WorldView const world = gi::view(world_);
    tbb::parallel_for(region.y, region.y + region.height, [&](int y) {
        thread_local std::vector<gi::PathStart> starts;
        std::size_t const row = std::size_t(y) * std::size_t(width) + std::size_t(region.x);
        map.hits(row, row + std::size_t(region.width), starts);
        for (int x = region.x; x < region.x + region.width; ++x) {
            gi::PathStart const& start = starts[std::size_t(x - region.x)];
            if (start.triangle == gi::kNoPrimitive) continue;
            bool const is_still = start.triangle < world_.static_triangles;
            if (wanted != Surfaces::all && is_still != (wanted == Surfaces::still)) continue;
            gi::Surface const& surface = world.surfaces[start.triangle];
            gi::vec3 const n = gi::shading_detail::triangle_normal(surface);
            float const along = glm::dot(n, start.ray.direction);
            float const t = along != 0 ? glm::dot(n, surface.corner - start.ray.origin) / along : 0;
            gi::vec2 const at = gi::barycentric_at(surface, start.ray.origin + t * start.ray.direction);
            gi::ShadingPoint const p = gi::shading_point(world, start.triangle, at, start.ray.direction);
            gi::vec3 const normal = p.frame.normal, albedo = gi::albedo(p.bsdf);
            gi::shading_detail::SurfacePoint where{surface, at};
            gi::shading_detail::interpolate_uv(world, where);
            gi::vec2 const place =
                gi::transform_uv(world.materials[surface.material].base_color_map, where.uv0, where.uv1);
            s.triangle.at<int>(y, x) = int(start.triangle);
            s.depth_m.at<float>(y, x) = glm::dot(p.position - rays.origin, rays.forward);
            s.normal.at<cv::Vec3f>(y, x) = {normal.x, normal.y, normal.z};
            s.albedo.at<cv::Vec3f>(y, x) = {albedo.x, albedo.y, albedo.z};
            s.place.at<cv::Vec2f>(y, x) = {place.x, place.y};
        }
    });
    return s;
}

void SurfaceView::rasterise(gi::Camera const& camera, int width, int height, cv::Rect region,
                            SurfaceRaster& into) const
{
    if (camera.orthographic) throw std::invalid_argument("first surfaces of an orthographic camera");
    into.region = region;
    into.world = gi::view(world_);
    into.rays = gi::camera_rays(camera, width, height, world_.origin);
    gi::CameraRays part = into.rays;
    part.corner += float(region.x) * part.step_x + float(region.y) * part.step_y;
    gi::PerspectiveGrid const grid =
        gi::camera_grid(part, region.width, region.height, gi::vec2(0.5f), gi::near_plane(world_.bounds));
    gi::clear(into.map, std::uint32_t(region.width), std::uint32_t(region.height));
    constexpr std::size_t kPart = 8 * gi::TriangleSoup::kChunk;
    tbb::parallel_for(std::size_t(0), (soup_.count + kPart - 1) / kPart, [&](std::size_t k) {
        thread_local gi::Fragments fragments;
        fragments.count = 0;
        gi::rasterize(soup_, k * kPart, std::min(soup_.count, (k + 1) * kPart), grid, fragments);
        cut_outs_.remove(fragments, grid, 0);
        gi::resolve_shared(fragments, 1, into.map);
    });
}

FirstSurface SurfaceView::surface_at(SurfaceRaster const& raster, gi::NearestTexel const& texel,
                                     gi::vec2 position) const
{
    gi::WorldView const& world = raster.world;
    gi::CameraRays const& rays = raster.rays;
    gi::vec3 const along = rays.corner + position.x * rays.step_x + position.y * rays.step_y;
    float const depth_m = 1 / texel.key;
    gi::vec2 const at = gi::barycentric_at(world.surfaces[texel.primitive], rays.origin + depth_m * along);
    gi::ShadingPoint const p = gi::shading_point(world, texel.primitive, at, glm::normalize(along));
    return {p.frame.normal, gi::albedo(p.bsdf), depth_m};
}

} // namespace ar
