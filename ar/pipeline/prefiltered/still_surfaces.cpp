#include "ar/pipeline/prefiltered/still_surfaces.h"

#include "gi/core/rng.h"
#include "gi/scene/shading/shading_point.h"

#include <tbb/parallel_for.h>
#include <unordered_map>

namespace ar {
namespace {

constexpr std::uint32_t kStillTexels = 96, kSharpStillTexels = 512;
constexpr std::size_t kMostPatches = 20000;
constexpr float kPatchesAcross = 12; ///< the moving surfaces' radius
constexpr float kRefit = 2;          ///< ratio of radii

void go_on(gi::BuildStop const& stop)
{
    if (stop.given_up()) throw gi::Interrupted{};
}

/// Points with equal keys lie in one cell of a grid and face the same way; cells grow with the distance.
std::uint64_t cell_key(gi::vec3 from_low, gi::vec3 n, float side_m, int level)
{
    glm::ivec3 const at(glm::clamp(glm::floor(from_low / side_m), 0.0f, float(0x3ffff)));
    gi::vec3 const a = glm::abs(n);
    int const axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return std::uint64_t(at.x) | std::uint64_t(at.y) << 18 | std::uint64_t(at.z) << 36 |
           std::uint64_t(2 * axis + (n[axis] > 0)) << 54 | std::uint64_t(level) << 57;
}

} // namespace

gi::Bounds bounds_of(gi::World const& world, std::size_t first, std::size_t last)
{
    gi::Bounds b;
    for (std::size_t t = first; t < last; ++t)
        for (int k = 0; k < 3; ++k) {
            gi::vec3 const p = world.positions[world.triangles[t][k]];
            if (!gi::all_finite(p)) continue;
            b.low = glm::min(b.low, p);
            b.high = glm::max(b.high, p);
        }
    return b;
}

void StillSurfaces::build(std::span<LightDirection const> directions, gi::TriangleSoup const& soup,
                          gi::CutOuts const& cut_outs, gi::BuildStop const& stop)
{
    still_.assign(directions.size(), {});
    facing_.assign(directions.size(), {});
    patches_.clear();
    seen_.clear();
    near_m_ = 0;
    bounds_ = bounds_of(world_, 0, world_.static_triangles);
    if (bounds_.empty()) return;
    tbb::parallel_for(std::size_t(0), directions.size(), [&](std::size_t k) {
        go_on(stop);
        LightDirection const& d = directions[k];
        gi::Pcg32 rng = gi::Pcg32::for_path(0, 0x0cc1, std::uint32_t(k));
        gi::vec2 const jitter = rng.uniform2();
        float const turn = 2 * gi::kPi * rng.uniform();
        still_[k].start(bounds_, d.towards, d.sharp ? kSharpStillTexels : kStillTexels, jitter, turn);
        still_[k].draw(soup, cut_outs, 0, world_.static_triangles, 0);
        facing_[k].start(bounds_, -d.towards, kStillTexels, jitter, turn);
        facing_[k].draw(soup, cut_outs, 0, world_.static_triangles, 0);
    });
}

bool StillSurfaces::fit_patches(std::span<LightDirection const> directions, gi::Bounds const& moving,
                                gi::BuildStop const& stop)
{
    if (bounds_.empty()) return false;
    // Flat or vanished objects have no size of their own.
    float const least_m = 1e-3f * bounds_.radius();
    float const near_m = moving.empty() ? bounds_.radius() : std::max(moving.radius(), least_m);
    if (!(near_m > 0) || (near_m_ > 0 && near_m < kRefit * near_m_ && kRefit * kRefit * near_m > near_m_))
        return false;
    near_m_ = near_m;
    for (float size_m = near_m / kPatchesAcross; !find_patches(directions, moving, size_m, stop);) size_m *= 1.5f;
    std::size_t const n = directions.size();
    seen_.resize(patches_.size() * n);
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t i) {
        go_on(stop);
        SurfacePatch const& at = patches_[i];
        for (std::size_t k = 0; k < n; ++k)
            seen_[i * n + k] = glm::dot(at.normal, directions[k].towards) > 0
                                   ? in_the_way(k, at.position, at.normal, at.triangle)
                                   : kOpen;
    });
    return true;
}

/// @return false: there would be too many
bool StillSurfaces::find_patches(std::span<LightDirection const> directions, gi::Bounds const& moving,
                                 float size_m, gi::BuildStop const& stop)
{
    gi::WorldView const view = gi::view(world_);
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    patches_.clear();
    patch_of_texel_.assign(directions.size(), {});
    for (std::size_t k = 0; k < directions.size(); ++k) {
        go_on(stop);
        OcclusionMap const& map = facing_[k];
        patch_of_texel_[k].assign(map.texels().size(), kUnknown);
        for (std::size_t t = 0; t < map.texels().size(); ++t) {
            gi::NearestTexel const& texel = map.texels()[t];
            if (texel.primitive == gi::kNoPrimitive) continue;
            gi::vec3 const p = map.grid().point(std::uint32_t(t % map.grid().width),
                                                std::uint32_t(t / map.grid().width), -texel.key);
            gi::vec3 n = gi::shading_detail::triangle_normal(view.surfaces[texel.primitive]);
            if (glm::dot(n, directions[k].towards) > 0) n = -n;
            float const away = moving.empty() ? 0 : glm::distance(p, moving.center()) / (3 * near_m_);
            int const level = away > 1 ? std::min(std::ilogb(away), 0x1f) : 0;
            auto const [entry, is_new] = known.try_emplace(
                cell_key(p - bounds_.low, n, std::ldexp(size_m, level), level), std::uint32_t(patches_.size()));
            gi::vec2 const where = gi::barycentric_at(view.surfaces[texel.primitive], p);
            gi::ShadingPoint const s = gi::shading_point(view, texel.primitive, where, -n);
            if (is_new) patches_.push_back({s.position, n, texel.primitive, gi::vec3(0), 0});
            SurfacePatch& patch = patches_[entry->second];
            patch.albedo += (gi::albedo(s.bsdf) - patch.albedo) / float(++patch.samples);
            patch_of_texel_[k][t] = entry->second;
        }
        if (patches_.size() > kMostPatches) return false;
    }
    return true;
}

std::uint32_t StillSurfaces::in_the_way(std::size_t k, gi::vec3 p, gi::vec3 normal, std::uint32_t triangle) const
{
    if (bounds_.empty()) return kOpen;
    gi::View<gi::Surface const> const surfaces(world_.surfaces);
    OcclusionMap const& facing = facing_[k];
    gi::NearestTexel const* const t = facing.texel(p);
    if (t == nullptr) return kOpen;
    // The first surface of the column, if the point is in front of it, is the first that is met.
    constexpr float kFar = 4; // texels
    float const gap = -t->key - facing.grid().depth(p);
    if (gap > 0 && t->primitive != triangle) {
        bool in_front = gap > kFar * facing.grid().texel;
        if (!in_front) {
            gi::Surface const& s = surfaces[t->primitive];
            gi::vec3 const n = glm::cross(s.edge1, s.edge2);
            float const side = glm::dot(n, p - s.corner);
            in_front = (glm::dot(n, facing.grid().axis) < 0 ? side : -side) > s.clearance * glm::length(n);
        }
        if (in_front) return patch_of_texel_[k][std::size_t(t - facing.texels().data())];
    }
    return still_[k].blocker(surfaces, p, normal, triangle) == gi::kNoPrimitive ? kOpen : kUnknown;
}

} // namespace ar
