#include "ar/pipeline/prefiltered/prefiltered_pairs.h"

#include "gi/scene/shading/shading_point.h"

#include <set>
#include <tbb/parallel_for.h>

namespace ar {
namespace {

/// Subsets of the directions, by pixel, for the picture without virtual objects: at most, and directions in each.
constexpr std::size_t kMostSubsets = 16, kLeastDirections = 8;

cv::Vec3f vector(gi::vec3 v) { return {v.x, v.y, v.z}; }

/// A point of a surface as a camera sees it.
struct Seen {
    LitPoint at;
    gi::vec3 reflectance; ///< diffuse, over pi

    gi::vec3 radiance(ReceivedLight const& light) const { return reflectance * light.irradiance + light.glossy; }
};

Seen seen_through(gi::WorldView const& world, gi::CameraRays const& rays, gi::NearestTexel const& texel, int x,
                  int y)
{
    gi::vec3 const along = rays.corner + (float(x) + 0.5f) * rays.step_x + (float(y) + 0.5f) * rays.step_y;
    gi::vec3 const direction = glm::normalize(along);
    gi::vec2 const where = gi::barycentric_at(world.surfaces[texel.primitive], rays.origin + along / texel.key);
    gi::ShadingPoint const s = gi::shading_point(world, texel.primitive, where, direction);
    gi::vec3 const n = s.frame.normal;
    float const cosine = -glm::dot(n, direction);
    return {{s.position, n, s.geometric_normal, texel.primitive, -direction, glossy_lobe_of(s.bsdf, cosine)},
            gi::kInvPi * gi::diffuse_albedo(s.bsdf, cosine)};
}

/// Far below the steps of a camera's bytes.
bool is_invisible(gi::vec3 change, gi::vec3 radiance)
{
    return gi::max_component(glm::abs(change)) < 1e-3f * gi::luminance(radiance);
}

/// The least roughness that a material has anywhere.
float least_alpha(gi::World const& world, gi::Material const& m, GlossyLobe const& lobe)
{
    if (m.model != gi::MaterialModel::metal_rough || m.metallic_roughness_map.texture < 0) return lobe.alpha;
    gi::TexturePool const& pool = world.scene->textures;
    gi::Texture const& texture = pool.textures[std::size_t(m.metallic_roughness_map.texture)];
    std::uint8_t least = 255;
    for (std::uint64_t k = 0; k < std::uint64_t(texture.width) * texture.height; ++k)
        least = std::min(least, pool.texels[texture.first + k].g);
    return lobe.alpha * gi::square(float(least) / 255);
}

std::string why_paths(gi::World const& world, std::uint32_t material, bool is_still)
{
    gi::Bsdf const& b = world.bsdfs[material];
    if (b.clear > 0) return "surfaces are glass";
    GlossyLobe const lobe = glossy_lobe_of(b, 1);
    // On still surfaces, weak reflections of virtual objects may be blurred.
    if (least_alpha(world, world.materials[material], lobe) < (is_still ? 0.25f : GlossyTable::kLeastAlpha) &&
        gi::max_component(lobe.reflectance) > (is_still ? 0.1f : 0.0f))
        return is_still ? "real surfaces are mirrors" : "virtual objects are mirrors";
    return {};
}

} // namespace

std::string needs_paths(gi::World const& world)
{
    if (!world.lights.empty()) return "the scenes have lights of their own";
    if (!world.emitters.empty()) return "surfaces emit light";
    std::set<std::pair<std::uint32_t, bool>> known; // material, is it of a still surface
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        bool const is_still = t < world.static_triangles;
        if (!known.emplace(world.triangle_material[t], is_still).second) continue;
        if (std::string why = why_paths(world, world.triangle_material[t], is_still); !why.empty()) return why;
    }
    return {};
}

PrefilteredPairs::PrefilteredPairs(gi::World const& world, gi::Report& report, gi::StopRequest const& stop)
    : world_(world),
      report_(report),
      light_(world, stop),
      all_(world, Surfaces::all),
      still_(world, Surfaces::still)
{
    report_counts();
}

void PrefilteredPairs::report_counts()
{
    report_.count("directions of prefiltered light", double(light_.counts().directions));
    report_.count("patches of real surfaces", double(light_.counts().patches));
}

void PrefilteredPairs::update(gi::Changes const& changes, gi::StopRequest const& stop)
{
    gi::StageTimer const timer(report_,
                               changes.environment ? "prefilter the light" : "occlusion maps of virtual objects");
    if (changes.geometry) all_.moved();
    if (changes.environment) light_.relight(stop);
    if (changes.geometry || changes.environment)
        light_.moved(stop);
    else
        light_.settle();
    if (changes.environment) report_counts();
}

PairPictures PrefilteredPairs::render(gi::Camera const& camera, int width, int height, gi::StopRequest const& stop)
{
    PairPictures p;
    cv::Size const size(width, height);
    for (cv::Mat* const m : {&p.with, &p.without, &p.direct}) *m = cv::Mat(size, CV_32FC3, cv::Scalar::all(0));
    for (cv::Mat* const m : {&p.coverage, &p.depth_m, &p.real_depth_m})
        *m = cv::Mat(size, CV_32FC1, cv::Scalar(0));
    cv::Rect const region({0, 0}, size);
    {
        gi::StageTimer const timer(report_, "first surfaces");
        all_.rasterise(camera, width, height, region, all_raster_);
        still_.rasterise(camera, width, height, region, still_raster_);
    }
    gi::StageTimer const timer(report_, "shade by prefiltered light");
    gi::WorldView const world = gi::view(world_);
    std::size_t const subsets =
        std::clamp<std::size_t>(light_.counts().directions / kLeastDirections, 1, kMostSubsets);
    tbb::parallel_for(0, height, [&](int y) {
        if (stop.requested()) return;
        for (int x = 0; x < width; ++x) {
            gi::NearestTexel const& first = all_raster_.texel(x, y);
            gi::NearestTexel const& behind = still_raster_.texel(x, y);
            if (behind.primitive != gi::kNoPrimitive) p.real_depth_m.at<float>(y, x) = 1 / behind.key;
            if (first.primitive == gi::kNoPrimitive) continue;
            p.depth_m.at<float>(y, x) = 1 / first.key;
            bool const is_virtual = !all_.is_still(first);
            gi::vec3 without(0), change(0);
            if (behind.primitive != gi::kNoPrimitive) {
                Seen const s = seen_through(world, still_raster_.rays, behind, x, y);
                if (!is_virtual) change = s.radiance(light_.change_on_still(s.at));
                without = s.radiance(light_.open_light(s.at));
                if (is_invisible(change, without)) change = gi::vec3(0);
                if (change != gi::vec3(0)) {
                    std::size_t const subset = std::size_t(x % 4 + 4 * (y % 4)) % subsets;
                    without = s.radiance(light_.on_still(s.at, subsets, subset));
                }
            }
            // The change is known better than the light without it.
            without = glm::max(without, -change);
            p.without.at<cv::Vec3f>(y, x) = vector(without);
            gi::vec3 with = without + change;
            if (is_virtual) {
                Seen const s = seen_through(world, all_raster_.rays, first, x, y);
                with = s.radiance(light_.on_moving(s.at));
                p.direct.at<cv::Vec3f>(y, x) = vector(with);
                p.coverage.at<float>(y, x) = 1;
            }
            p.with.at<cv::Vec3f>(y, x) = vector(with);
        }
    });
    return p;
}

} // namespace ar
