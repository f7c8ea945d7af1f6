#pragma once
// Gaze as a session recorded it.

#include "study/signals/gaze.h"
#include "study/tables/dataset.h"

#include <filesystem>

namespace study {

/// The samples of a session: the tables that its parts name in the journal (gaze_table), with times since the
/// session's beginning. Places are px from the window's top left corner.
struct SessionGaze {
    std::vector<GazeSample> samples;
    std::vector<int> steps;           ///< of the plan, from 0; -1 = none
    int unreadable = 0;               ///< lines that are no samples, left out
    std::vector<std::string> remarks; ///< where they are
    std::vector<InputFile> files;
};
/// @param dir  of all records. A table that is missing is that of a part that ended before its first trial.
SessionGaze read_session_gaze(std::filesystem::path const& dir, Script const& script,
                              RecordedSession const& session);

} // namespace study
