#include "gi/methods/paths/look_up_trust.h"

#include "gi/hit_buffers/query.h"
#include "gi/hit_buffers/windows.h"
#include "gi/methods/paths/primary_map.h"
#include "gi/raster/nearest_map.h"
#include "gi/scene/shading/shading_point.h"

#include <algorithm>
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <vector>

namespace gi {
namespace {

constexpr float kLargeTexel = 1.0f / 16; ///< relative to the median distance
constexpr int kPixels = 48;              ///< pixels per side that are sampled

struct Start {
    vec3 position;
    std::uint32_t triangle;
    vec3 towards; ///< a direction on the side to which light leaves
};

/// Surfaces that the camera sees, at one point each in a grid of sampled pixels.
std::vector<Start> seen_by(CameraRays const& camera, TriangleSoup const& soup, float near_m)
{
    PerspectiveGrid const grid = camera_grid(camera, kPixels, kPixels, vec2{0.5f}, near_m);
    NearestMap map;
    clear(map, grid.width, grid.height);
    constexpr std::size_t kPart = 32 * TriangleSoup::kChunk;
    tbb::parallel_for(std::size_t(0), (soup.count + kPart - 1) / kPart, [&](std::size_t k) {
        BorrowedFragments fragments;
        rasterize(soup, k * kPart, std::min(soup.count, (k + 1) * kPart), grid, *fragments);
        resolve_shared(*fragments, 1, map);
    });
    std::vector<Start> starts;
    for (std::uint32_t j = 0; j < grid.height; ++j)
        for (std::uint32_t i = 0; i < grid.width; ++i) {
            NearestTexel const& t = map.texels[j * grid.width + i];
            if (t.primitive == kNoPrimitive) continue;
            starts.push_back({grid.point(i, j, t.key), t.primitive, -grid.direction(i, j)});
        }
    return starts;
}

/// True if two triangles lie in one plane, at the resolution of texels.
bool same_surface(Surface const& a, Surface const& b, float texel)
{
    constexpr float kAlike = 0.5f; // cosine
    vec3 const normal = shading_detail::triangle_normal(a);
    vec3 const middle = b.corner + (b.edge1 + b.edge2) / 3.0f;
    return glm::dot(normal, shading_detail::triangle_normal(b)) > kAlike &&
           std::abs(glm::dot(normal, middle - a.corner)) <= 0.5f * texel;
}

/// True if a look-up may start on another surface than its own.
bool starts_elsewhere(AxisView const& axis, View<Surface const> surfaces, WalkOrigin const& o)
{
    using namespace query_detail;
    RasterGrid const& grid = axis.grid();
    TexelsAround const around(grid, o.position);
    for (int k = 0; k < 4; ++k) {
        Column const c = look_into(axis, std::size_t(around.row(k)) * grid.width + around.column(k), o);
        if (c.own && !same_surface(surfaces[c.own_triangle], surfaces[o.triangle], grid.texel)) return true;
    }
    return false;
}

/// The buffer of the finest level over a point.
HitBuffer const& finest(std::vector<HitBuffer> const& levels, vec3 point)
{
    std::size_t level = levels.size() - 1;
    while (level > 0 && !levels[level].grid.holds(point)) --level;
    return levels[level];
}

struct Agreed {
    std::size_t asked = 0, agreed = 0;
};

/// Follows all starts along one axis. @param levels  of its buffers @return the surfaces hit
std::vector<Start> continue_paths(std::vector<Start> const& starts, std::vector<HitBuffer> const& levels,
                                  View<Surface const> surfaces, Agreed& sums)
{
    vec3 const along = levels[0].grid.axis;
    std::vector<Start> met;
    for (Start const& s : starts) {
        AxisView const axis{{view(finest(levels, s.position)), {}}};
        vec3 const normal = shading_detail::triangle_normal(surfaces[s.triangle]);
        float const out = glm::dot(normal, s.towards) < 0 ? -1.0f : 1.0f, side = out * glm::dot(normal, along);
        if (!(std::abs(side) > 1e-3f)) continue;
        WalkOrigin const o{s.position, s.triangle, glm::dot(normal, along) > 0, side > 0,
                           std::sqrt(std::max(0.0f, 1 - side * side)) / std::abs(side)};
        LayerHit const hit = nearest_layer(axis, surfaces, o);
        ++sums.asked;
        sums.agreed += is_doubtful(axis, surfaces, o, hit) || starts_elsewhere(axis, surfaces, o) ? 0 : 1;
        if (hit.triangle != kNoLayerHit) met.push_back({hit.position, hit.triangle, side > 0 ? -along : along});
    }
    return met;
}

} // namespace

double look_up_agreement(World const& world, TriangleSoup const& soup, CameraRays const& camera,
                         SlhbSettings const& settings)
{
    auto const resolution = std::uint32_t(settings.resolution);
    Windows windows(settings);
    windows.follow(world.bounds, soup, {&camera, 1});
    vec3 const axes[] = {{0.36f, 0.48f, 0.8f}, {0.64f, -0.6f, 0.48f}};
    std::array<std::vector<HitBuffer>, 2> buffers;
    tbb::parallel_for(std::size_t(0), buffers.size(), [&](std::size_t k) {
        auto const make = [&](Bounds const& box) {
            RasterGrid const grid = make_window(box, world.bounds, axes[k], resolution, vec2{0.5f}, 0.5f);
            buffers[k].push_back(make_hit_buffer(soup, grid));
        };
        make(world.bounds);
        for (Bounds const& box : windows.boxes()) make(box);
    });
    Agreed sums;
    std::vector<Start> const seen = seen_by(camera, soup, near_plane(world.bounds));
    std::vector<float> texels; // over distances
    for (Start const& s : seen)
        texels.push_back(finest(buffers[0], s.position).grid.texel / glm::length(s.position - camera.origin));
    if (!texels.empty()) {
        auto const middle = texels.begin() + std::ptrdiff_t(texels.size() / 2);
        std::ranges::nth_element(texels, middle);
        if (*middle > kLargeTexel) return 0;
    }
    std::vector<Start> const met = continue_paths(seen, buffers[0], view(world).surfaces, sums);
    continue_paths(met, buffers[1], view(world).surfaces, sums);
    return sums.asked > 0 ? double(sums.agreed) / double(sums.asked) : 1;
}

void report_untrusted_look_ups(World const& world, TriangleSoup const& soup, CameraRays const& camera,
                               SlhbSettings const& settings, Report& report)
{
    double const trusted = look_up_agreement(world, soup, camera, settings);
    // Measured: light wrong by 2 % at 0.55, by 43 % at 0; where exact rays decide, by 1 % at 0.2, by 13 % at 0.
    constexpr double kMisleading = 0.75, kMisleadingWithRays = 0.1;
    if (trusted >= (settings.confirm == Confirming::on ? kMisleadingWithRays : kMisleading)) return;
    Windows windows(settings);
    windows.follow(world.bounds, soup, {&camera, 1});
    Bounds const& box = windows.boxes().empty() ? world.bounds : windows.boxes().back();
    float const texel_m =
        make_grid(box, vec3{0, 1, 0}, std::uint32_t(settings.resolution), vec2{0.5f}, 0.5f).texel;
    report.lose(
        "pictures whose look-ups are not reliable: light may be wrong by more than the estimated error; exact are "
        "--method paths, reference and auto",
        1,
        fmt::format("{:.0f} % of look-ups can be trusted, texels are {:.2g} m wide around the camera",
                    100 * trusted, texel_m));
}

} // namespace gi
