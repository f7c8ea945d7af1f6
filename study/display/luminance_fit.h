#pragma once
// Fits a display's luminance to measurements.

#include "study/display/display_model.h"

namespace study {

enum class PatchColour { white, red, green, blue };
inline constexpr std::array kPatchColours{PatchColour::white, PatchColour::red, PatchColour::green,
                                          PatchColour::blue};
char const* name_of(PatchColour colour);

/// A photometer's reading.
struct LuminanceReading {
    PatchColour colour = PatchColour::white;
    double value = 0; ///< digital, 0..1
    double cd_m2 = 0;
};

/// A match by eye: an area of which `share` of the lines is white and the rest black looked like this value.
struct GammaMatch {
    PatchColour colour = PatchColour::white;
    double share = 0.5; ///< of the light, 0..1
    double value = 0;   ///< digital, 0..1
};

struct LuminanceFit {
    DisplayLuminance light;
    std::vector<std::string> warnings;
};

/// Least squares of relative errors (with a floor of 1/20000 of the peak,
/// where photometers are dark-limited). Readings of one colour and value are averaged;
/// a warning says where they differ by more than 5 %. Channels without readings of their own share white's curve;
/// their peaks are then those of `colour`, or of sRGB's primaries.
/// @throws gi::InputError no white and not all three channels, fewer than three values of a colour,
///     no value 1, luminance that does not rise, falls by more than a fifth to the highest value,
///     or rises as no display's does
LuminanceFit fit_luminance(std::vector<LuminanceReading> readings, std::optional<DisplayColour> const& colour);

/// Gamma from matches; gain is 1, black is typed. @param white, black  cd/m2; none = unknown: relative
/// @throws gi::InputError  no match, or a match at an end of the values
LuminanceFit fit_matches(std::vector<GammaMatch> const& matches, std::optional<double> white,
                         std::optional<double> black, std::optional<DisplayColour> const& colour);

/// Shares of red, green and blue in the luminance of white, from chromaticities. @throws gi::InputError they lie
/// on a line, or a share is negative
std::array<double, 3> luminance_shares(DisplayColour const& colour);
/// IEC 61966-2-1
inline constexpr DisplayColour kSrgbColour{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/// Reads a table: a header, then colour, value and cd/m2. Columns are named `channel` (or colour), `value` and
/// `cd_m2` (or luminance), in any order; colours are white (grey, w), red, green, blue. Values are 0..1, or 0..255
/// if one is above 1. @throws gi::InputError with file:line:column
std::vector<LuminanceReading> read_readings(std::string const& text, std::string const& file);
/// Their table, which read_readings() reads.
std::string readings_text(std::vector<LuminanceReading> const& readings);

/// Values of a photometer's series: `count` from 0 to 1, evenly spaced in whole 255ths.
std::vector<double> series_values(int count);

} // namespace study
