#pragma once
// Formats a session's records as a table.

#include "ar/runtime/runner.h"

namespace ar {

/// CSV with a header line and one line per frame. Numbers missing between two lines are lost frames.
std::string frame_table(RunSummary const& summary);

} // namespace ar
