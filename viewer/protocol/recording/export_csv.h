#pragma once
// Exports a recording as a CSV table: one row per frame; '#' lines at the top with the meaning and unit of each
// column; numbers with the fewest digits that restore the same double.

#include "viewer/protocol/recording/recording.h"

namespace viewer {

/// Exports all frames. There are columns for the largest number of views in any frame; frames with fewer leave
/// theirs empty. The file appears whole or not at all. Throws InputError if `file` cannot be written.
/// @return how the recording ended; the caller reports a loss
RecordingEnd export_csv(RecordingReader& recording, std::filesystem::path const& file);

} // namespace viewer
