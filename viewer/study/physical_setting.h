#pragma once
// Settings of stimuli in physical units: size and place in degrees, centimetres or pixels, luminance in cd/m2.

#include <optional>
#include <string>

namespace viewer {

enum class StimulusUnit { deg, cm, px };
char const* name_of(StimulusUnit unit);

/// Two lengths with one unit: "4 deg" (both alike), "4 x 3 deg", "-5 2.5 deg".
struct StimulusLength {
    double x = 0, y = 0;
    StimulusUnit unit = StimulusUnit::deg;
    bool operator==(StimulusLength const&) const = default;
};

enum class LuminanceOf { white, mean, peak };
/// The luminance with which a rendered value of 1 is shown, or the mean or peak of the first picture.
struct StimulusLuminance {
    LuminanceOf of = LuminanceOf::white;
    double cd_m2 = 0;
    bool operator==(StimulusLuminance const&) const = default;
};

inline constexpr double kBrightest_cd_m2 = 1e6;

struct PhysicalStimulus {
    std::optional<StimulusLength> size;  ///< of the picture; none = as large as its place
    std::optional<StimulusLength> place; ///< of its centre, from the centre of its place: right, up
    std::optional<StimulusLuminance> luminance;
    bool any() const { return size || place || luminance; }
    /// True if they are only known with the screen's size and distance, or its luminance.
    bool needs_screen() const;
    bool needs_luminance() const { return luminance.has_value(); }
    bool operator==(PhysicalStimulus const&) const = default;
};

/// size, place, luminance, mean_luminance, peak_luminance
bool is_physical_setting(std::string const& key);
/// Sets what the setting says. Numbers without a unit are degrees and cd/m2. Throws InputError on another unit,
/// sizes and luminances that are not positive.
void set_physical(PhysicalStimulus& stimulus, std::string const& key, std::string const& text);
/// For hashes; empty if nothing is set.
std::string text_of(PhysicalStimulus const& stimulus);

} // namespace viewer
