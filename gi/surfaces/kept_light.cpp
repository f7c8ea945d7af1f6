#include "gi/surfaces/kept_light.h"

#include "gi/filter/filter_input.h"
#include "gi/render/surface_likeness.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Distance from the plane of a surface at which another one begins, relative to the depth.
constexpr float kOfDepth = 0.005f;

} // namespace

struct KeptLight::Sum {
    vec3 direct{0}, indirect{0}, weights{0};
    float likeness = 0;

    void add(Texel const& t, float weight, float like)
    {
        vec3 w{weight * (like + kLeastLikeness)};
        for (int c = 0; c < 3; ++c)
            if ((t.dark >> c & 1) != 0) w[c] = 0;
        direct += w * t.direct;
        indirect += w * t.indirect;
        weights += w;
        likeness = std::max(likeness, like);
    }
    FoundLight mean() const
    {
        FoundLight f{direct, indirect, likeness};
        for (int c = 0; c < 3; ++c) {
            float const n = weights[c] > 0 ? 1 / weights[c] : 0;
            f.direct[c] *= n;
            f.indirect[c] *= n;
        }
        return f;
    }
};

KeptLight::KeptLight(Picture const& picture, CameraRays const& camera, dvec3 origin)
    : camera_(camera), project_(camera), width_(picture.width), height_(picture.height), texels_(picture.pixels())
{
    Layer const &l1 = needed_layer(picture, "L1"), &l2 = needed_layer(picture, "L2"),
                &albedo = needed_layer(picture, "albedo"), &normal = needed_layer(picture, "normal"),
                &position = needed_layer(picture, "position");
    tbb::parallel_for(0, height_, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width_) + std::size_t(x);
            Texel& t = texels_[i];
            vec3 const a = rgb(albedo, i), n = rgb(normal, i), p{dvec3(rgb(position, i)) - origin};
            t = {p, 0, n, 0, over_albedo(rgb(l1, i), a), over_albedo(rgb(l2, i), a)};
            for (int c = 0; c < 3; ++c) t.dark |= a[c] < kDarkest ? 1u << c : 0;
            bool const known =
                n != vec3{0} && in_range(p) && in_range(t.direct) && in_range(t.indirect) && t.dark != 7;
            if (!known) continue;
            t.normal = glm::normalize(n);
            float const depth = glm::dot(p - camera_.origin, camera_.forward);
            t.reach = depth > 0 ? 1 / std::max(kOfDepth * depth, 1e-30f) : 0;
        }
    });
}

float KeptLight::likeness(Texel const& t, vec3 position, vec3 normal)
{
    return surface_likeness(t.normal, normal, glm::dot(t.normal, position - t.position) * t.reach);
}

FoundLight KeptLight::find(vec3 position, vec3 normal, vec2 place) const
{
    Sum sum;
    float const u = place.x - 0.5f, v = place.y - 0.5f;
    int const left = int(std::floor(u)), top = int(std::floor(v));
    float const fx = u - float(left), fy = v - float(top);
    auto const take = [&](int x, int y, float weight) {
        if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
        Texel const& t = texels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
        if (t.reach > 0) sum.add(t, weight, likeness(t, position, normal));
    };
    constexpr float kBeside = 0.02f; // least weight, so that a pixel at the place does not count alone
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
            take(left + i, top + j, (i == 0 ? 1 - fx : fx) * (j == 0 ? 1 - fy : fy) + kBeside);
    if (sum.likeness > 0.3f) return sum.mean();
    for (int j = -1; j < 3; ++j)
        for (int i = -1; i < 3; ++i)
            if (i < 0 || j < 0 || i > 1 || j > 1) take(left + i, top + j, 0.25f);
    return sum.mean();
}

std::optional<FoundLight> KeptLight::find(vec3 position, vec3 normal) const
{
    vec3 const at = project_(position);
    if (!(at.z > 0) ||
        !(at.x > -0.5f && at.y > -0.5f && at.x < float(width_) + 0.5f && at.y < float(height_) + 0.5f))
        return std::nullopt;
    return find(position, normal, vec2(at));
}

} // namespace gi
