#include "gi/surfaces/light_picture.h"

#include "gi/filter/filter_input.h"

#include <glm/gtc/packing.hpp>

namespace gi {

namespace {

/// Octahedral, as unpackSnorm2x16 unpacks it.
std::uint32_t packed_normal(vec3 normal)
{
    float const size = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    vec2 o = vec2(normal) / size;
    if (normal.z < 0) {
        auto const fold = [](float a, float b) { return (1 - std::abs(b)) * (a < 0 ? -1.0f : 1.0f); };
        o = {fold(o.x, o.y), fold(o.y, o.x)};
    }
    return glm::packSnorm2x16(o);
}

} // namespace

std::uint32_t packed_light(vec3 light) { return glm::packF3x9_E1x5(glm::max(light, vec3{0})); }

LightTexel light_texel(vec3 position, vec3 normal, vec3 light, unsigned dark, float depth)
{
    return {packed_normal(normal), glm::dot(normal, position), packed_light(light),
            (std::bit_cast<std::uint32_t>(depth) & ~(kDarkBits | kPictureMirrors << kMirrorShift)) | dark};
}

vec3 unpacked_normal(std::uint32_t bits)
{
    vec2 const o = glm::unpackSnorm2x16(bits);
    vec3 n{o.x, o.y, 1 - std::abs(o.x) - std::abs(o.y)};
    float const fold = std::max(-n.z, 0.0f);
    n.x -= n.x < 0 ? -fold : fold;
    n.y -= n.y < 0 ? -fold : fold;
    return glm::normalize(n);
}

LightSlope light_slope(vec3 mean_normal, vec3 slope)
{
    LightSlope s{packed_normal(mean_normal), 0};
    for (int c = 0; c < 3; ++c) {
        int const steps = int(std::lround(glm::clamp(slope[c] / kSlopeStep, -511.0f, 511.0f)));
        s.slope |= std::uint32_t(steps + 512) << (10 * c);
    }
    return s;
}

void make_image(LightPicture& light, std::size_t texel, std::uint32_t mirror)
{
    mat3 const reflect = reflection(light.mirrors[mirror - 1]);
    LightTexel& t = light.texels[texel];
    if (!has_surface(t)) return;
    t.normal = packed_normal(reflect * unpacked_normal(t.normal));
    t.depth_dark |= mirror << kMirrorShift;
    if (light.slopes.empty()) return;
    LightSlope& s = light.slopes[texel];
    if (s.slope == 0) return;
    vec3 slope;
    for (int c = 0; c < 3; ++c) slope[c] = kSlopeStep * (float(s.slope >> (10 * c) & 1023) - 512);
    s = light_slope(reflect * unpacked_normal(s.mean_normal), reflect * slope);
}

void find_mean(LightPicture& light)
{
    constexpr std::size_t kStep = 17;
    dvec3 sum{0}, count{0};
    for (std::size_t i = 0; i < light.texels.size(); i += kStep) {
        LightTexel const& t = light.texels[i];
        vec3 const l = glm::unpackF3x9_E1x5(t.light);
        for (int c = 0; c < 3 && has_surface(t); ++c)
            if ((t.depth_dark >> c & 1) == 0) {
                sum[c] += l[c];
                count[c] += 1;
            }
    }
    light.mean = vec3(sum / glm::max(count, dvec3(1)));
}

LightPicture light_picture(Picture const& picture, Camera const& camera, std::size_t most_texels)
{
    Layer const *l1 = picture.find("L1"), *l2 = picture.find("L2"), *albedo = picture.find("albedo"),
                *normal = picture.find("normal"), *position = picture.find("position");
    LightPicture light;
    if (!l1 || !l2 || !albedo || !normal || !position) return light;
    int step = 1;
    while (std::size_t(picture.width / step) * std::size_t(picture.height / step) > most_texels) ++step;
    light.width = picture.width / step;
    light.height = picture.height / step;
    light.camera = camera;
    light.camera_width = picture.width;
    light.camera_height = picture.height;
    light.texels_per_pixel = 1 / float(step);
    light.at = vec2{(float(step / 2) + 0.5f) / float(step)};
    light.texels.resize(std::size_t(light.width) * std::size_t(light.height));
    dvec3 const from = dvec3(camera.world_from_camera[3]), forward = -dvec3(camera.world_from_camera[2]);
    for (int y = 0; y < light.height; ++y)
        for (int x = 0; x < light.width; ++x) {
            std::size_t const i =
                std::size_t(y * step + step / 2) * std::size_t(picture.width) + std::size_t(x * step + step / 2);
            vec3 const a = rgb(*albedo, i), n = rgb(*normal, i), p(dvec3(rgb(*position, i)) - from),
                       l = over_albedo(rgb(*l1, i) + rgb(*l2, i), a);
            if (n == vec3{0} || !in_range(p) || !in_range(l)) continue;
            unsigned dark = 0;
            for (int c = 0; c < 3; ++c) dark |= a[c] < kDarkest ? 1u << c : 0u;
            float const depth = float(glm::dot(dvec3(p), forward));
            if (dark != 7 && depth > 0)
                light.texels[std::size_t(y) * std::size_t(light.width) + std::size_t(x)] =
                    light_texel(p, glm::normalize(n), l, dark, depth);
        }
    find_mean(light);
    return light;
}

} // namespace gi
