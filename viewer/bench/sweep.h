#pragma once
// Methods against each other: every scene, every budget of time, the error that is left at its end.

#include "viewer/offline/render_options.h"
#include "viewer/report/table.h"

namespace viewer {

struct SweepOptions {
    RenderOptions render; ///< what all have in common: size, bounces, camera, sky, threads
    std::vector<std::string> scenes, methods, budgets;
    std::uint32_t reference_paths = 1024;
    std::string reference; ///< a picture to take instead
    int repeats = 3;
    std::string out;
};

struct SweepResult {
    BenchTable table;
    bool interrupted = false; ///< the table holds what was done before
};

/// Writes tables and pictures to the folder as they come. All that can be wrong with the call is found before
/// anything is rendered or written (InputError).
SweepResult run_sweep(SweepOptions const& options);

} // namespace viewer
