#include "ar/pipeline/prefiltered/prefiltered_pairs.h"

#include "gi/scene/shading/shading_point.h"

#include <tbb/parallel_for.h>

namespace viewer {
namespace {

constexpr std::size_t kSubsets = 8; ///< of the directions, by pixel, for the picture without virtual objects

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
    GlossyLobe const lobe = glossy_lobe_of(s.bsdf, -glm::dot(n, direction));
    gi::Bsdf const& b = s.bsdf;
    float const through = b.coat_f90 > 0 ? 1 - gi::schlick_mean(b.coat_f0, b.coat_f90) : 1.0f;
    return {{s.position, n, s.geometric_normal, texel.primitive, -direction, lobe},
            gi::kInvPi * through * b.diffuse};
}

/// Far below the steps of a camera's bytes.
bool is_invisible(gi::vec3 change, gi::vec3 radiance)
{
    return gi::max_component(glm::abs(change)) < 1e-3f * gi::luminance(radiance);
}

} // namespace

std::string needs_paths(gi::World const& world)
{
    if (!world.lights.empty()) return "the scenes have lights of their own";
    if (!world.emitters.empty()) return "surfaces emit light";
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        gi::Bsdf const& b = world.bsdfs[world.triangle_material[t]];
        if (b.clear > 0) return "surfaces are glass";
        GlossyLobe const lobe = glossy_lobe_of(b, 1);
        // On still surfaces, weak reflections of virtual objects may be blurred.
        bool const is_still = t < world.static_triangles;
        if (lobe.alpha < (is_still ? 0.25f : GlossyTable::kLeastAlpha) &&
            gi::max_component(lobe.reflectance) > (is_still ? 0.1f : 0.0f))
            return is_still ? "real surfaces are mirrors" : "virtual objects are mirrors";
    }
    return {};
}

PrefilteredPairs::PrefilteredPairs(gi::World const& world, gi::Report& report)
    : world_(world), report_(report), light_(world), all_(world, Surfaces::all), still_(world, Surfaces::still)
{
    report_counts();
}

void PrefilteredPairs::report_counts()
{
    report_.count("directions of prefiltered light", double(light_.counts().directions));
    report_.count("patches of real surfaces", double(light_.counts().patches));
}

void PrefilteredPairs::update(gi::Changes const& changes)
{
    gi::StageTimer const timer(report_,
                               changes.environment ? "prefilter the light" : "occlusion maps of virtual objects");
    if (changes.geometry) all_.moved();
    if (changes.environment) light_.relight();
    if (changes.geometry || changes.environment)
        light_.moved();
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
                if (is_invisible(change, s.radiance(light_.open_light(s.at)))) change = gi::vec3(0);
                std::size_t const subset = std::size_t(x % 4 + 4 * (y % 2));
                without = s.radiance(change != gi::vec3(0) ? light_.on_still(s.at, kSubsets, subset)
                                                           : light_.open_light(s.at));
            }
            p.without.at<cv::Vec3f>(y, x) = vector(without);
            gi::vec3 with = glm::max(without + change, gi::vec3(0));
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

} // namespace viewer
