#pragma once
// An analysis of gaze as tables and as files of BIDS.

#include "study/gaze/gaze_analysis.h"
#include "study/tables/result_table.h"

namespace study {

/// gaze_recordings, gaze_samples, main_sequences, gaze_conditions (means of participants), gaze_views, fixations (with their numbers: scan paths),
/// saccades. Places are pixels from the upper left corner of the screen.
std::vector<ResultTable> gaze_tables(GazeAnalysis const& analysis);

/// A derivative data set of BIDS: for each recording NAME_desc-gaze_physioevents.tsv.gz with its .json file, a row per
/// fixation, saccade and loss, in the order of their times.
std::vector<TextFile> gaze_derivatives(GazeAnalysis const& analysis, std::string const& program_version);

} // namespace study
