#pragma once
#include "viewer/experiment/prepared.h"

#include <map>

namespace viewer {

/// All that the blocks with `stimuli: prepared` show, over all participants, by their keys; of levels that a
/// procedure chooses all that it may. Throws InputError where these cannot be told before (adjustment).
/// @param screen_px  of the participant's window   @param font_px  of its letters: places leave room for text
std::map<std::string, PreparedStimulus> prepared_list(study::Script const& script, glm::ivec2 screen_px,
                                                      float font_px, std::string const& version);

} // namespace viewer
