#pragma once
// From linear radiance to a display: exposure, a curve, the sRGB encoding.

#include "gi/core/view.h"
#include "gi/image_io/picture.h"

namespace gi {

enum class ToneCurve : std::uint8_t {
    srgb,  ///< clip at 1
    filmic ///< Narkowicz 2015, a fit of ACES: rolls bright light off
};

struct ToneMapSettings {
    float exposure_ev = 0; ///< stops: radiance is multiplied by 2^ev
    ToneCurve curve = ToneCurve::srgb;
};

/// IEC 61966-2-1, for v in [0, 1].
GI_FN inline float encode_srgb(float v)
{
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

/// One value per item, display-encoded in [0, 1]; NaN becomes 0.
struct ToneMap {
    View<float const> in;
    View<float> out;
    float scale;
    ToneCurve curve;

    GI_FN void operator()(std::size_t i) const
    {
        float v = in[i] * scale;
        v = v > 0 ? glm::min(v, 1e6f) : 0.0f;
        if (curve == ToneCurve::filmic) v = v * (2.51f * v + 0.03f) / (v * (2.43f * v + 0.59f) + 0.14f);
        out[i] = encode_srgb(glm::min(v, 1.0f));
    }
};

/// Red, green and blue of a layer, display-encoded in [0, 1]; grey layers three times the same.
std::vector<float> tone_map(Layer const& layer, ToneMapSettings const& settings);
/// The same in bytes.
std::vector<unsigned char> tone_map_bytes(Layer const& layer, ToneMapSettings const& settings);
/// R, G, B, A. PNG keeps colours that are not multiplied by their coverage: they are divided by it, 0 where it is
/// 0.
/// @param color multiplied by @param alpha, one channel, 0..1
std::vector<unsigned char> tone_map_bytes(Layer const& color, Layer const& alpha, ToneMapSettings const& settings);

} // namespace gi
