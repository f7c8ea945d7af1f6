#pragma once
// A calibrated display: luminance of every digital value, size, distance and colour of its screen, and how they
// were measured. docs/displays.md describes the file.
//
// A channel (red, green, blue) emits, for a digital value d in [0, 1], the luminance of black plus
//     peak * (max(0, gain d + 1 - gain)^gamma - o) / (1 - o),  o = max(0, 1 - gain)^gamma
// (gain-offset-gamma: Berns, Motta and Gorzynski 1993, Color Res. Appl. 18(5):299-314), or what its table says.
// The channels add up: L(r, g, b) = black + the three of them; `additivity_error` is what was measured of that.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace study {

/// Light of one channel above black.
struct ChannelCurve {
    double peak = 0; ///< cd/m2 at value 1 (or a fraction of white, where nothing was measured in cd/m2)
    double gamma = 2.2, gain = 1;
    std::vector<std::pair<double, double>> table; ///< value 0..1, share of the peak 0..1; both rise; empty = none
    double rms_percent = 0, worst_percent = 0;    ///< residuals of the formula, of the measured luminance
    int points = 0;                               ///< measured values
    bool operator==(ChannelCurve const&) const = default;
};

enum class LuminanceMethod {
    photometer, ///< measured in cd/m2
    by_eye,     ///< gamma by matching patterns; luminances typed, or unknown
};

struct DisplayLuminance {
    LuminanceMethod method = LuminanceMethod::photometer;
    bool is_absolute = true; ///< in cd/m2; else relative to white = 1
    double black = 0;        ///< of value 0, cd/m2
    std::array<ChannelCurve, 3> channels{};
    bool uses_table = false;                ///< the tables count, not the formula
    std::optional<double> additivity_error; ///< (R + G + B - 2 black) / W - 1
    double white() const { return black + channels[0].peak + channels[1].peak + channels[2].peak; }
    bool operator==(DisplayLuminance const&) const = default;
};

/// CIE 1931 chromaticity.
struct Chromaticity {
    double x = 0, y = 0;
    bool operator==(Chromaticity const&) const = default;
};
struct DisplayColour {
    Chromaticity red, green, blue, white;
    bool operator==(DisplayColour const&) const = default;
};

struct ScreenGeometry {
    int width_px = 0, height_px = 0;    ///< of the monitor's mode
    double width_cm = 0, height_cm = 0; ///< of the picture
    double distance_cm = 0;             ///< from the eyes to its centre; 0 = unknown
    std::string method;                 ///< "typed", "card"
    bool operator==(ScreenGeometry const&) const = default;
};

struct DisplayModel {
    std::string date, by, instrument, room;    ///< date: 2026-11-26
    std::string monitor, connector;            ///< name (EDID where it has one); "DP-1"
    double refresh_hz = 0;                     ///< 0 = unknown
    int bits = 8;                              ///< per channel
    std::optional<ScreenGeometry> screen;      ///< none = not measured
    std::optional<double> ipd_mm;              ///< distance of the participant's pupils
    std::optional<DisplayLuminance> luminance; ///< none = not measured
    std::optional<DisplayColour> colour;       ///< none = not measured
    std::string sha256;                        ///< of the file that it was read from
};

/// Share of the channel's peak that a value gives, 0..1.
double share_of_value(DisplayLuminance const& light, int channel, double value);
/// Value in [0, 1] that gives this share of the channel's peak; shares beyond the ends give the ends.
double value_of_share(DisplayLuminance const& light, int channel, double share);

/// Values of one channel (grey: the three together) for shares of the peak: what pictures are shown with.
/// @param steps  of the table; entry i is for the share (i / (steps - 1))^2.2, so that dark ones are dense
std::vector<std::array<float, 3>> inverse_table(DisplayLuminance const& light, int steps);
inline constexpr double kInverseTableExponent = 2.2;

} // namespace study
