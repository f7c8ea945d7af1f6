#pragma once
#include "viewer/experiment/stimulus_source.h"

namespace viewer {

/// From where a stimulus is seen.
struct StimulusPlace {
    gi::Camera camera;            ///< at its beginning
    double radius_m = 1;          ///< of the scene
    double screen_distance_m = 2; ///< where both eyes' pictures coincide: the middle of the scene
};

StimulusPlace place_of(gi::World const& world, gi::Camera const& camera);
/// One view or those of two eyes, so long after the beginning; none where the place has no pixels.
std::vector<ViewCommand> stimulus_views(StimulusPlace const& place, StimulusSettings const& stimulus,
                                        StimulusView const& view, double seconds);

} // namespace viewer
