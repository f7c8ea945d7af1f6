#pragma once
// The views that show a stimulus.

#include "viewer/experiment/stimuli/stimulus_source.h"

namespace viewer {

/// Viewpoint of a stimulus.
struct StimulusPlace {
    gi::Camera camera;            ///< start pose
    double radius_m = 1;          ///< of the scene
    double screen_distance_m = 2; ///< distance where both eyes' pictures coincide: the scene's centre
};

StimulusPlace place_of(gi::World const& world, gi::Camera const& camera);
/// One view, or two for stereo, at a time after the start; none if the place has no pixels.
std::vector<ViewCommand> stimulus_views(StimulusPlace const& place, StimulusSettings const& stimulus,
                                        StimulusView const& view, double seconds);

} // namespace viewer
