#pragma once
// A session's records as a table.

#include "ar/runtime/runner.h"

namespace viewer {

/// CSV with a heading: a line for each frame. Numbers that are missing between two lines are frames that were lost
/// on the way.
std::string frame_table(ArSummary const& summary);

} // namespace viewer
