#pragma once
// A recording as a table that any program reads: one row per frame, '#' lines at the top that say what each column
// is and in which unit, numbers in the fewest digits that give the same double back.

#include "viewer/protocol/recording/recording.h"

namespace viewer {

/// From the first frame on. Columns of views are as many as the frame with the most has; the others leave theirs
/// empty. Appears whole or not at all. Throws InputError if `file` cannot be written.
/// @return how the recording ended; its loss is for the caller to report
RecordingEnd export_csv(RecordingReader& recording, std::filesystem::path const& file);

} // namespace viewer
