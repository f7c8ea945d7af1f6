#pragma once
// What a source could not give is not lost in silence.

#include "ar/capture/frame_source.h"
#include "gi/core/report.h"

namespace viewer {

/// Counts what was refused. @throws gi::InputError the source broke off
void report_losses(ar::SourceCounts const& counts, ar::SourceState const& state, gi::Report& report);

} // namespace viewer
