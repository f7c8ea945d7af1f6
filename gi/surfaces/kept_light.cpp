#include "gi/surfaces/kept_light.h"

#include "gi/filter/filter_input.h"
#include "gi/render/surface_likeness.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Limits of the factor by which light changes if it is taken by a surface that faces another way.
constexpr float kLeastTurned = 0.2f, kMostTurned = 4;

} // namespace

struct KeptLight::Sum {
    vec3 direct{0}, indirect{0}, weights{0};
    float likeness = 0;

    void add(Texel const& t, vec3 normal, float weight, float like)
    {
        // A fit for one surface is not valid for one that faces another way.
        float const change = like < kUnlike ? 0 : glm::dot(t.slope, normal - t.mean_normal),
                    turned = std::clamp(1 + change, kLeastTurned, kMostTurned);
        vec3 w{weight * (like + kLeastLikeness)};
        for (int c = 0; c < 3; ++c)
            if ((t.dark >> c & 1) != 0) w[c] = 0;
        direct += w * turned * t.direct;
        indirect += w * turned * t.indirect;
        weights += w;
        likeness = std::max(likeness, like);
    }
    /// @param unknown  light where the albedo of all is too dark to know it
    FoundLight mean(FoundLight const& unknown) const
    {
        FoundLight f{direct, indirect, likeness};
        for (int c = 0; c < 3; ++c) {
            float const n = weights[c] > 0 ? 1 / weights[c] : 0;
            f.direct[c] = n > 0 ? f.direct[c] * n : unknown.direct[c];
            f.indirect[c] = n > 0 ? f.indirect[c] * n : unknown.indirect[c];
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
    Layer const* const mean_normal = picture.find("light_normal");
    tbb::parallel_for(0, height_, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width_) + std::size_t(x);
            Texel& t = texels_[i];
            vec3 const a = rgb(albedo, i), n = rgb(normal, i), p{dvec3(rgb(position, i)) - origin};
            t = {p,
                 0,
                 n,
                 0,
                 over_albedo(rgb(l1, i), a),
                 over_albedo(rgb(l2, i), a),
                 mean_normal && in_range(rgb(*mean_normal, i)) ? rgb(*mean_normal, i) : n,
                 {}};
            for (int c = 0; c < 3; ++c) t.dark |= a[c] < kDarkest ? 1u << c : 0;
            bool const known =
                n != vec3{0} && in_range(p) && in_range(t.direct) && in_range(t.indirect) && t.dark != 7;
            if (!known) continue;
            t.normal = glm::normalize(n);
            float const depth = glm::dot(p - camera_.origin, camera_.forward);
            t.reach = depth > 0 ? 1 / std::max(kOfDepth * depth, 1e-30f) : 0;
        }
    });
    if (mean_normal) find_slopes();
    dvec3 direct{0}, indirect{0}, count{0};
    for (Texel const& t : texels_)
        for (int c = 0; c < 3 && t.reach > 0; ++c)
            if ((t.dark >> c & 1) == 0) {
                direct[c] += double(t.direct[c]);
                indirect[c] += double(t.indirect[c]);
                count[c] += 1;
            }
    mean_.direct = vec3(direct / glm::max(count, dvec3(1)));
    mean_.indirect = vec3(indirect / glm::max(count, dvec3(1)));
}

/// Fits light = a + b * normal to the texels around each one, by ridge regression weighted by distance.
void KeptLight::find_slopes()
{
    constexpr int kTaps = 1, kStep = 3;  // to each side; texels between them
    constexpr float kNear = 0.1f;        // distance of half the weight, relative to the depth
    constexpr float kRidge = 0.002f;     // variance of normals below which little is learnt from them
    constexpr float kLeastOfMean = 0.1f; // light below this share of the mean counts as so much
    tbb::parallel_for(0, height_, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            Texel& t = texels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
            if (!(t.reach > 0)) continue;
            float const by_near2 = square(t.reach * kOfDepth / kNear);
            float weights = 0, light = 0;
            vec3 normals{0}, products{0};
            mat3 squares{0};
            for (int v = std::max(y % kStep, y - kTaps * kStep); v <= std::min(height_ - 1, y + kTaps * kStep);
                 v += kStep)
                for (int u = std::max(x % kStep, x - kTaps * kStep); u <= std::min(width_ - 1, x + kTaps * kStep);
                     u += kStep) {
                    Texel const& other = texels_[std::size_t(v) * std::size_t(width_) + std::size_t(u)];
                    if (!(other.reach > 0) || other.dark != t.dark) continue; // other channels, another luminance
                    vec3 const away = other.position - t.position, n = other.mean_normal - t.mean_normal;
                    float const w = 1 / (1 + square(glm::dot(away, away) * by_near2)),
                                e = luminance(other.direct + other.indirect);
                    weights += w;
                    light += w * e;
                    normals += w * n;
                    products += w * e * n;
                    squares += glm::outerProduct(w * n, n);
                }
            float const mean = light / weights;
            vec3 const mean_n = normals / weights, covariance = products / weights - mean * mean_n;
            mat3 const variance = squares * (1 / weights) - glm::outerProduct(mean_n, mean_n) + mat3(kRidge);
            float const own = std::max(luminance(t.direct + t.indirect), kLeastOfMean * mean);
            vec3 const slope = glm::inverse(variance) * covariance / own;
            t.slope = own > 0 && in_range(slope) ? slope : vec3{0};
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
        if (t.reach > 0) sum.add(t, normal, weight, likeness(t, position, normal));
    };
    constexpr float kBeside = 0.02f; // least weight, so that a pixel at the place does not count alone
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
            take(left + i, top + j, (i == 0 ? 1 - fx : fx) * (j == 0 ? 1 - fy : fy) + kBeside);
    if (sum.likeness > 0.3f) return sum.mean(mean_);
    for (int j = -1; j < 3; ++j)
        for (int i = -1; i < 3; ++i)
            if (i < 0 || j < 0 || i > 1 || j > 1) take(left + i, top + j, 0.25f);
    return sum.mean(mean_);
}

LightPicture KeptLight::picture() const
{
    LightPicture light;
    light.width = width_;
    light.height = height_;
    light.texels.resize(texels_.size());
    light.slopes.resize(texels_.size());
    tbb::parallel_for(0, height_, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width_) + std::size_t(x);
            Texel const& t = texels_[i];
            if (!(t.reach > 0)) continue;
            vec3 const from = t.position - camera_.origin;
            light.texels[i] =
                light_texel(from, t.normal, t.direct + t.indirect, t.dark, glm::dot(from, camera_.forward));
            light.slopes[i] = light_slope(t.mean_normal == vec3{0} ? t.normal : t.mean_normal, t.slope);
        }
    });
    // A pixel that nobody saw before has the noise of its few paths: it is no brighter or darker than those around it.
    constexpr float kBeyond = 1.2f, kAlike = 0.3f;
    tbb::parallel_for(0, height_, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width_) + std::size_t(x);
            Texel const& t = texels_[i];
            if (!(t.reach > 0)) continue;
            float low = kInf, high = 0;
            for (int v = std::max(0, y - 1); v <= std::min(height_ - 1, y + 1); ++v)
                for (int u = std::max(0, x - 1); u <= std::min(width_ - 1, x + 1); ++u) {
                    Texel const& o = texels_[std::size_t(v) * std::size_t(width_) + std::size_t(u)];
                    // Other channels, another luminance.
                    if ((u == x && v == y) || !(o.reach > 0) || o.dark != t.dark ||
                        !(likeness(o, t.position, t.normal) > kAlike))
                        continue;
                    float const l = luminance(o.direct + o.indirect);
                    low = std::min(low, l);
                    high = std::max(high, l);
                }
            vec3 const own = t.direct + t.indirect;
            float const l = luminance(own), wanted = std::clamp(l, low / kBeyond, std::max(low, high) * kBeyond);
            if (!(low < kInf) || wanted == l) continue;
            light.texels[i].light = packed_light(l > 0 ? own * (wanted / l) : vec3{wanted});
        }
    });
    find_mean(light);
    return light;
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
