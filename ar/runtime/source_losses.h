#pragma once
// Reports frames that a source could not deliver.

#include "ar/capture/frame_source.h"
#include "gi/core/report.h"

namespace viewer {

/// Counts refused frames. @throws gi::InputError if the source was lost
void report_losses(ar::SourceCounts const& counts, ar::SourceState const& state, gi::Report& report);

} // namespace viewer
