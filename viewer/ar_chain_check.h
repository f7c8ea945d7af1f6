#pragma once
// Runs the generated counter through the whole chain of augmented reality, size by size
// (viewer/ar/run/counter_check.h).

#include "gi/base/progress.h"
#include "gi/base/report.h"
#include "viewer/bench/table.h"

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
