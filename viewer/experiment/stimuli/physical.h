#pragma once
// Stimuli with sizes, places and luminances (viewer/study/physical_setting.h) on a display.

#include "gi/image_io/picture.h"
#include "study/display/display_model.h"
#include "viewer/displays/display_light.h"
#include "viewer/study/physical_setting.h"

#include <glm/vec2.hpp>
#include <memory>

namespace viewer {

/// Throws InputError unless the model can show it: there is none, it lacks size, distance or luminance, the
/// luminance is out of its range, or the picture is larger than the screen or ends beyond its edge.
/// @param model  null = none
void check_physical(PhysicalStimulus const& stimulus, study::DisplayModel const* model);

/// What shows a stimulus.
struct ShownOn {
    study::DisplayModel const* model = nullptr; ///< null = none
    bool has_own_views = false;                 ///< walls or a headset, where sizes and luminances have no meaning
};
/// Throws InputError unless a display can show what one physical setting says (check_physical).
void check_physical(std::string const& key, std::string const& text, ShownOn const& shown_on);

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
