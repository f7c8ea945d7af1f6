#include "gi/scene/generate/sky.h"

namespace gi {

EnvironmentMap generate_sky(vec3 to_sun)
{
    EnvironmentMap map;
    map.width = 128;
    map.height = 64;
    constexpr vec3 kZenith{0.22f, 0.42f, 0.85f}, kHorizon{0.85f, 0.95f, 1.05f}, kGlow{1.6f, 1.35f, 1.0f},
        kGround{0.28f, 0.25f, 0.20f};
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            float const theta = kPi * (float(y) + 0.5f) / float(map.height);
            float const phi = 2 * kPi * ((float(x) + 0.5f) / float(map.width) - 0.5f);
            vec3 const d{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
            vec3 radiance = kGround;
            if (d.y > 0) {
                float const toward = glm::max(0.0f, glm::dot(d, to_sun));
                radiance = glm::mix(kHorizon, kZenith, std::pow(d.y, 0.45f)) + kGlow * std::pow(toward, 24.0f);
            }
            map.radiance.push_back(radiance);
        }
    return map;
}

} // namespace gi
