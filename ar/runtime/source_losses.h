#pragma once
// Reports frames that a source could not deliver.

#include "ar/capture/frame_source.h"
#include "gi/core/report.h"

namespace ar {

/// Counts refused frames. @throws gi::InputError if the source was lost
void report_losses(SourceCounts const& counts, SourceState const& state, gi::Report& report);

} // namespace ar
