#pragma once
// Tone mapping from linear radiance to a display: exposure, tone curve, sRGB encoding.

#include "gi/core/view.h"
#include "gi/image_io/picture.h"

namespace gi {

enum class ToneCurve : std::uint8_t {
    srgb,  ///< clip at 1
    filmic ///< fit of ACES by Narkowicz 2015: compresses highlights
};

struct ToneMapSettings {
    float exposure_ev = 0; ///< stops: radiance is multiplied by 2^ev
    ToneCurve curve = ToneCurve::srgb;
    bool operator==(ToneMapSettings const&) const = default;
};

/// sRGB encoding (IEC 61966-2-1) of v in [0, 1].
GI_FN inline float encode_srgb(float v)
{
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

/// Kernel that maps one value per item to [0, 1], display-encoded; NaN becomes 0.
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

/// Returns red, green and blue of a layer, display-encoded in [0, 1]; grey layers give three equal values.
std::vector<float> tone_map(Layer const& layer, ToneMapSettings const& settings);
/// The same as bytes.
std::vector<unsigned char> tone_map_bytes(Layer const& layer, ToneMapSettings const& settings);
/// Returns R, G, B, A bytes. PNG stores colours without premultiplied alpha, so colours
/// are divided by alpha; 0 if alpha is 0.
/// @param color  multiplied by alpha  @param alpha  one channel, 0..1
std::vector<unsigned char> tone_map_bytes(Layer const& color, Layer const& alpha, ToneMapSettings const& settings);

} // namespace gi
