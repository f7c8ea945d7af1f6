#pragma once
// How a calibrated display shows linear light: radiance to luminance to digital values. The CPU twin of
// shaders/display.frag with CALIBRATED.
//
// A rendered value v (after exposure and tone curve) asks each channel for the luminance v * white * (its share of
// the display's white). Above the display's black B that is the share  (v * white - B) / (display's white - B)  of
// its peak, for all channels alike, because their blacks are shares of B in the same way.

#include "gi/filter/tone_map.h"
#include "study/display/display_model.h"

#include <memory>

namespace viewer {

/// Digital values for shares of the peak (study::inverse_table), shared by all windows of a display.
using InverseTable = std::vector<std::array<float, 3>>;
inline constexpr int kInverseTableSteps = 4096;

struct DisplayLight {
    std::shared_ptr<InverseTable const> table; ///< null = none: sRGB is assumed
    float gain = 1, black = 0;                 ///< share = gain * v - black
};

/// @param white_cd_m2  with which the value 1 is shown; none = the display's own white
DisplayLight display_light(study::DisplayLuminance const& light, std::shared_ptr<InverseTable const> table,
                           std::optional<double> white_cd_m2);
std::shared_ptr<InverseTable const> make_inverse_table(study::DisplayLuminance const& light);

/// Digital value of a channel, a whole number of 255ths. @param v  radiance; NaN = 0
float encode(DisplayLight const& light, int channel, float v, gi::ToneMapSettings const& tone);

/// What a picture looks like on the display.
struct ShownLight {
    double mean_cd_m2 = 0, peak_cd_m2 = 0; ///< of pixels
    std::size_t pixels = 0;
    std::size_t bright = 0; ///< pixels with a channel beyond the display's peak
    std::size_t dark = 0;   ///< pixels with a channel darker than the display's black, but not 0
};
/// @param color  3 channels of radiance (or 1: grey)
ShownLight shown_light(gi::Layer const& color, gi::ToneMapSettings const& tone, DisplayLight const& light,
                       study::DisplayLuminance const& display);
/// Mean and peak of the values v, weighted by the channels' shares of white: luminance if white were 1 cd/m2.
std::pair<double, double> mean_and_peak(gi::Layer const& color, gi::ToneMapSettings const& tone,
                                        study::DisplayLuminance const& display);

} // namespace viewer
