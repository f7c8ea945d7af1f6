#pragma once
// Runs the generated counter through the whole chain of augmented reality, size by size
// (ar/runtime/counter_check.h).

#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "viewer/report/table.h"

namespace viewer {

struct ChainCheckSettings {
    std::vector<std::string> sizes; ///< "640x480"
    int frames = 20;                ///< to be shown
    bool in_window = false;
};

struct ChainChecked {
    BenchTable table; ///< a row per size
    bool good = true;
};

/// @param stop  also asked for where the window is closed
ChainChecked check_chain(ChainCheckSettings const& settings, gi::StopRequest& stop, gi::Report& report);

} // namespace viewer
