#pragma once
// Runs the generated counter session through the whole AR pipeline, once per frame
// size (ar/runtime/counter_check.h).

#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "viewer/report/table.h"

namespace viewer {

struct ChainCheckSettings {
    std::vector<std::string> sizes; ///< "640x480"
    int frames = 20;                ///< number of frames to show
    bool in_window = false;
};

struct ChainChecked {
    BenchTable table; ///< one row per size
    bool good = true;
};

/// @param stop  also requested when the window is closed
ChainChecked check_chain(ChainCheckSettings const& settings, gi::StopRequest& stop, gi::Report& report);

} // namespace viewer
