#pragma once
// Samples of gaze beside the journals, and their form in the data set.

#include "study/signals/gaze.h"
#include "study/tables/dataset.h"
#include "study/tables/table.h"

#include <filesystem>

namespace viewer {

/// The samples of a session: the tables that its parts name in the journal (gaze_table), with times since the
/// session's beginning. Places are px from the window's top left corner. A missing table or a damaged line is
/// named on stderr and left out.
struct RecordedGaze {
    std::vector<study::GazeSample> samples;
    std::vector<int> steps; ///< of the plan, from 0; -1 = none
};
RecordedGaze read_gaze(std::filesystem::path const& dir, study::Script const& script,
                       study::RecordedSession const& session);

/// Its .tsv.gz and .json (BIDS eye tracking), relative to the data set; none without samples.
std::vector<study::TextFile> gaze_files(std::filesystem::path const& dir, study::Script const& script,
                                        study::RecordedSession const& session);

} // namespace viewer
