#include "viewer/displays/display_light.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

/// Exposure and tone curve, without clipping at white.
float toned(float radiance, float scale, gi::ToneCurve curve)
{
    float v = radiance * scale;
    v = v > 0 ? std::min(v, 1e6f) : 0.0f;
    if (curve == gi::ToneCurve::filmic) v = v * (2.51f * v + 0.03f) / (v * (2.43f * v + 0.59f) + 0.14f);
    return v;
}

/// Calls f with the three values of each pixel.
template <class F>
void each_pixel(gi::Layer const& color, gi::ToneMapSettings const& tone, F const& f)
{
    std::size_t const channels = std::size_t(color.channels),
                      count = color.data.size() / std::max<std::size_t>(1, channels);
    float const scale = std::exp2(tone.exposure_ev);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 3> v{};
        for (std::size_t c = 0; c < 3; ++c)
            v[c] = toned(color.data[i * channels + (channels >= 3 ? c : 0)], scale, tone.curve);
        f(v);
    }
}

std::array<double, 3> shares_of_white(study::DisplayLuminance const& d)
{
    double const range = d.white() - d.black;
    return {d.channels[0].peak / range, d.channels[1].peak / range, d.channels[2].peak / range};
}

} // namespace

std::shared_ptr<InverseTable const> make_inverse_table(study::DisplayLuminance const& light)
{
    return std::make_shared<InverseTable const>(study::inverse_table(light, kInverseTableSteps));
}

DisplayLight display_light(study::DisplayLuminance const& light, std::shared_ptr<InverseTable const> table,
                           std::optional<double> white_cd_m2)
{
    double const range = light.white() - light.black;
    return {std::move(table), float(white_cd_m2.value_or(light.white()) / range), float(light.black / range)};
}

float encode(DisplayLight const& light, int channel, float radiance, gi::ToneMapSettings const& tone)
{
    float const v = toned(radiance, std::exp2(tone.exposure_ev), tone.curve);
    float const share = std::clamp(light.gain * v - light.black, 0.0f, 1.0f);
    auto const& table = *light.table;
    float const at = std::pow(share, float(1 / study::kInverseTableExponent)) * float(table.size() - 1);
    auto const below = std::min(std::size_t(at), table.size() - 2);
    float const f = at - float(below);
    auto const c = std::size_t(channel);
    float const value = table[below][c] + f * (table[below + 1][c] - table[below][c]);
    return std::floor(value * 255 + 0.5f) / 255;
}

ShownLight shown_light(gi::Layer const& color, gi::ToneMapSettings const& tone, DisplayLight const& light,
                       study::DisplayLuminance const& display)
{
    auto const share_of = shares_of_white(display);
    double const range = display.white() - display.black;
    ShownLight shown;
    double sum = 0;
    each_pixel(color, tone, [&](std::array<float, 3> const& v) {
        double y = 0;
        bool bright = false, dark = false;
        for (std::size_t c = 0; c < 3; ++c) {
            float const share = light.gain * v[c] - light.black;
            bright = bright || share > 1.0005f; // half a step of 8 bits at the top is no clipping
            dark = dark || (share < 0 && v[c] > 0);
            y += share_of[c] * double(std::clamp(share, 0.0f, 1.0f));
        }
        double const cd_m2 = display.black + range * y;
        sum += cd_m2;
        shown.peak_cd_m2 = std::max(shown.peak_cd_m2, cd_m2);
        shown.bright += bright;
        shown.dark += dark;
        ++shown.pixels;
    });
    if (shown.pixels > 0) shown.mean_cd_m2 = sum / double(shown.pixels);
    return shown;
}

std::pair<double, double> mean_and_peak(gi::Layer const& color, gi::ToneMapSettings const& tone,
                                        study::DisplayLuminance const& display)
{
    auto const share_of = shares_of_white(display);
    double sum = 0, peak = 0;
    std::size_t count = 0;
    each_pixel(color, tone, [&](std::array<float, 3> const& v) {
        double const y = share_of[0] * double(v[0]) + share_of[1] * double(v[1]) + share_of[2] * double(v[2]);
        sum += y;
        peak = std::max(peak, y);
        ++count;
    });
    return {count > 0 ? sum / double(count) : 0, peak};
}

} // namespace viewer
