#pragma once
// Settings that an experiment varies although they change no picture.

#include "viewer/experiment/stimuli/stimulus_settings.h"

#include <string>
#include <vector>

namespace viewer {

/// Of the settings that levels of factors and procedures vary, those that the method of no stimulus uses: one line each.
std::vector<std::string> find_idle_settings(study::Script const& script,
                                            std::vector<PlannedStimulus> const& stimuli);

} // namespace viewer
