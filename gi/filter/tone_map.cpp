#include "gi/filter/tone_map.h"

#include "gi/kernel/launch.h"

namespace gi {
namespace {

std::vector<float> rgb_values(Layer const& layer)
{
    if (layer.channels == 3) return layer.data;
    std::size_t const pixels = layer.data.size() / std::size_t(layer.channels);
    std::vector<float> out(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        vec3 const c = rgb(layer, i);
        for (int k = 0; k < 3; ++k) out[3 * i + std::size_t(k)] = c[k];
    }
    return out;
}

} // namespace

std::vector<float> tone_map(Layer const& layer, ToneMapSettings const& settings)
{
    std::vector<float> const in = rgb_values(layer);
    std::vector<float> out(in.size());
    launch(Space::host, "tone map", in.size(), ToneMap{in, out, std::exp2(settings.exposure_ev), settings.curve});
    return out;
}

std::vector<unsigned char> tone_map_bytes(Layer const& layer, ToneMapSettings const& settings)
{
    std::vector<unsigned char> out;
    for (float const v : tone_map(layer, settings)) out.push_back(static_cast<unsigned char>(v * 255 + 0.5f));
    return out;
}

std::vector<unsigned char> tone_map_bytes(Layer const& color, Layer const& alpha, ToneMapSettings const& settings)
{
    Layer straight{color.name, 3, rgb_values(color)};
    for (std::size_t i = 0; i < straight.data.size(); ++i) {
        float const a = alpha.data[i / 3];
        straight.data[i] = a > 0 ? straight.data[i] / a : 0.0f;
    }
    std::vector<unsigned char> const bytes = tone_map_bytes(straight, settings);
    std::vector<unsigned char> out;
    for (std::size_t p = 0; p < alpha.data.size(); ++p) {
        out.insert(out.end(), bytes.begin() + std::ptrdiff_t(3 * p), bytes.begin() + std::ptrdiff_t(3 * p + 3));
        out.push_back(static_cast<unsigned char>(glm::clamp(alpha.data[p], 0.0f, 1.0f) * 255 + 0.5f));
    }
    return out;
}

} // namespace gi
