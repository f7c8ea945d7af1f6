#include "gi/methods/paths/partner_light.h"

#include "gi/scene/shading/narrow_lobes.h"
#include "gi/scene/shading/shading_point.h"

namespace gi {
namespace {

/// Smallest cosine between shading normals at which light counts as equal.
constexpr float kSameNormal = 0.98f;
/// Largest distance of the partner's point within and from the surface's plane, in the partner's pixels.
constexpr float kAside_px = 1.5f, kOff_px = 0.25f;
/// Largest angle between the views, relative to the lobe's GGX alpha.
constexpr float kShareOfLobe = 0.2f;
/// Light over smaller albedos is unknown.
constexpr float kDark = 1e-3f;

/// Width of the lobes as GGX alpha; 0 = some lobe is narrow.
float lobe_width(Bsdf const& b)
{
    if (bsdf_detail::is_matt(b)) return kInf;
    if (has_narrow_lobe(b)) return 0;
    return b.model == MaterialModel::phong ? std::sqrt(2 / (b.phong_exponent + 2)) : b.alpha;
}

} // namespace

bool PartnerLight::same_light(ShadingPoint const& at, std::uint32_t triangle, std::size_t pixel,
                              vec3 direction) const
{
    PathSample const& there = samples_[pixel];
    std::uint32_t const other = partner_.triangle(pixel);
    if (!there.hit || other == kNoPrimitive) return false;
    if (world_.surfaces[other].material != world_.surfaces[triangle].material) return false;
    if (!(glm::dot(at.frame.normal, there.normal) > kSameNormal)) return false;
    vec3 const apart = at.position - there.position;
    float const pixel_m = there.depth * glm::length(partner_camera_.step_x);
    vec3 const ray = glm::normalize(there.position - partner_camera_.origin);
    float const slope = std::max(0.1f, std::abs(glm::dot(ray, at.geometric_normal)));
    if (std::abs(glm::dot(apart, at.geometric_normal)) > kOff_px * pixel_m + at.clearance) return false;
    if (glm::length(apart) > kAside_px * pixel_m / slope) return false;
    float const width = lobe_width(at.bsdf);
    if (width < kInf && !(glm::length(ray - direction) < kShareOfLobe * width)) return false;
    vec3 const here = albedo(at.bsdf);
    for (int c = 0; c < 3; ++c)
        if (there.albedo[c] < kDark && here[c] >= kDark) return false;
    return true;
}

std::uint32_t PartnerLight::find(PathStart const& start, PathSample& sample) const
{
    if (start.triangle == kNoPrimitive) return kOwnLight;
    ShadingPoint const at = shading_point(
        world_, start.triangle, barycentric_of(world_.surfaces[start.triangle], start.ray), start.ray.direction);
    auto const pixel = partner_.pixel_near(at.position);
    if (!pixel || !same_light(at, start.triangle, *pixel, start.ray.direction)) return kOwnLight;
    sample = {};
    sample.hit = true;
    sample.radiance[0] = at.emission;
    sample.albedo = albedo(at.bsdf);
    sample.normal = at.frame.normal;
    sample.position = at.position;
    sample.depth = glm::dot(at.position - camera_.origin, camera_.forward);
    return std::uint32_t(*pixel);
}

bool same_surface(PixelMeans const& a, PixelMeans const& b, double pixel_m)
{
    // The mean of different normals is shorter than 1.
    if (a.hits == 0 || b.hits == 0 || !(glm::dot(a.normal, b.normal) > kSameNormal)) return false;
    return std::abs(double(glm::dot(a.position - b.position, a.normal))) < 2 * double(kOff_px) * pixel_m;
}

void take_light(PathSample const& partner, PathSample& sample)
{
    for (int c = 0; c < 3; ++c) {
        float const ratio = partner.albedo[c] < kDark ? 0 : sample.albedo[c] / partner.albedo[c];
        sample.radiance[1][c] = ratio * partner.radiance[1][c];
        sample.radiance[2][c] = ratio * partner.radiance[2][c];
    }
}

} // namespace gi
