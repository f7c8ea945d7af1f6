#pragma once
// `lightwell bench sweep`: errors of methods in every scene with every time budget.

#include "viewer/offline/render_options.h"
#include "viewer/report/table.h"

namespace viewer {

struct SweepOptions {
    RenderOptions render; ///< common to all renders: size, bounces, camera, sky, threads
    std::vector<std::string> scenes, methods, budgets;
    std::uint32_t reference_paths = 1024;
    std::string reference; ///< reference picture to use instead; empty = render one
    int repeats = 3;
    std::string out;
};

struct SweepResult {
    BenchTable table;
    bool interrupted = false; ///< the table holds what was finished before
};

/// Writes tables and pictures to the folder as they are finished. Throws InputError before rendering or writing if
/// the call is invalid.
SweepResult run_sweep(SweepOptions const& options);

} // namespace viewer
