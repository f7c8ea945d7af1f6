#include "gi/scene/generate/procedural_texture.h"

#include "gi/core/rng.h"

namespace gi {
namespace {

float corner(int x, int y, int cells, std::uint32_t seed)
{
    auto const wrap = [cells](int v) { return std::uint64_t((v % cells + cells) % cells); };
    return float(mix_bits((wrap(x) << 40) ^ (wrap(y) << 20) ^ seed) >> 40) * 0x1p-24f;
}

std::uint8_t encode(float v, bool srgb)
{
    v = glm::clamp(v, 0.0f, 1.0f);
    if (srgb) v = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
    return std::uint8_t(v * 255 + 0.5f);
}

} // namespace

float tileable_noise(vec2 uv, int cells, std::uint32_t seed)
{
    float sum = 0, weight = 0.5f;
    for (int octave = 0; octave < 4; ++octave, cells *= 2, weight *= 0.5f) {
        vec2 const p = uv * float(cells);
        int const x = int(std::floor(p.x)), y = int(std::floor(p.y));
        vec2 f = p - vec2{float(x), float(y)};
        f = f * f * (3.0f - 2.0f * f);
        auto const at = [&](int dx, int dy) {
            return corner(x + dx, y + dy, cells, seed + std::uint32_t(octave));
        };
        sum += weight * glm::mix(glm::mix(at(0, 0), at(1, 0), f.x), glm::mix(at(0, 1), at(1, 1), f.x), f.y);
    }
    return sum / 0.9375f;
}

std::int32_t add_procedural_texture(TexturePool& pool, int size, bool srgb, std::function<vec4(vec2)> const& color)
{
    Texture t;
    t.first = pool.texels.size();
    t.width = t.height = std::uint32_t(size);
    t.srgb = srgb;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            vec4 const c = color({(float(x) + 0.5f) / float(size), (float(y) + 0.5f) / float(size)});
            pool.texels.push_back({encode(c.x, srgb), encode(c.y, srgb), encode(c.z, srgb), encode(c.w, false)});
        }
    pool.textures.push_back(t);
    return std::int32_t(pool.textures.size()) - 1;
}

} // namespace gi
