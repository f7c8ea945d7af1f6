#pragma once
#include "viewer/experiment/stimuli/prepared.h"

#include <map>

namespace viewer {

/// All stimuli of blocks with `stimuli: prepared`, over all participants, by key, including all levels that a
/// procedure may choose. Throws InputError if the levels are not known in advance (adjustment).
/// @param screen_px  size of the participant's window   @param font_px  letter height: places leave room for text
/// @param model  for sizes in degrees; null = none
std::map<std::string, PreparedStimulus> prepared_list(study::Script const& script, glm::ivec2 screen_px,
                                                      float font_px, std::string const& version,
                                                      study::DisplayModel const* model = nullptr);
/// The same for one session's plan.
std::map<std::string, PreparedStimulus> prepared_list(study::Script const& script, study::Plan const& plan,
                                                      glm::ivec2 screen_px, float font_px,
                                                      std::string const& version,
                                                      study::DisplayModel const* model = nullptr);

} // namespace viewer
