#pragma once
// Physical units of a stimulus: size and place in degrees, centimetres or pixels, luminance in cd/m2.

#include "gi/image_io/picture.h"
#include "study/display/display_model.h"
#include "viewer/displays/display_light.h"

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

enum class StimulusUnit { deg, cm, px };

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

struct PhysicalStimulus {
    std::optional<StimulusLength> size;  ///< of the picture; none = as large as its place
    std::optional<StimulusLength> place; ///< of its centre, from the centre of its place: right, up
    std::optional<StimulusLuminance> luminance;
    bool any() const { return size || place || luminance; }
    /// True if they are only known with the screen's size and distance, or its luminance.
    bool needs_screen() const;
    bool needs_luminance() const { return luminance.has_value(); }
};

/// size, place, luminance, mean_luminance, peak_luminance
bool is_physical_setting(std::string const& key);
/// Sets what the setting says. Numbers without a unit are degrees and cd/m2. Throws InputError on another unit,
/// sizes and luminances that are not positive.
void set_physical(PhysicalStimulus& stimulus, std::string const& key, std::string const& text);
/// For hashes; empty if nothing is set.
std::string text_of(PhysicalStimulus const& stimulus);

/// Throws InputError unless the model can show it: there is none, it lacks size, distance or luminance, the
/// luminance is out of its range, or the picture is larger than the screen. @param model  null = none
void check_physical(PhysicalStimulus const& stimulus, study::DisplayModel const* model);

/// How a stimulus is shown on a calibrated display. @param first  its first picture, which sets the scale of mean
/// and peak luminances; null = white's luminance
DisplayLight light_of(PhysicalStimulus const& stimulus, study::DisplayLuminance const& display,
                      std::shared_ptr<InverseTable const> table, gi::Layer const* first,
                      gi::ToneMapSettings const& tone);

/// Rectangle of the stimulus within its place, px, from the same corner. Throws InputError if it does not fit.
struct PlacedPixels {
    glm::ivec2 corner_px{}, size_px{};
};
PlacedPixels placed_within(PhysicalStimulus const& stimulus, study::DisplayModel const* model,
                           glm::ivec2 corner_px, glm::ivec2 size_px);

} // namespace viewer
