#pragma once
// `lightwell bench dynamic`: frames of moving scenes with different hit buffer structures: cost of each part,
// error of each frame, and effect of temporal reuse.

#include "viewer/offline/render_options.h"
#include "viewer/report/table.h"

namespace viewer {

struct DynamicOptions {
    RenderOptions render;
    std::vector<std::string> scenes, structures{"static", "rebuilt", "appended", "streamed"};
    std::vector<std::uint32_t> triangles; ///< triangles of rooms in which a figure walks
    std::string out;
    int frames = 24, most_frames = 16;
    double fps = 30;
    std::uint32_t reference_paths = 64; ///< per pixel of each frame; 0 = no errors
    int seeds = 1;                      ///< repetitions of every sequence; the lag of reuse needs 4 or more
};

struct DynamicResult {
    BenchTable frames, summary;
};

/// Writes tables and pictures to the folder as they are finished. Throws InputError.
DynamicResult run_dynamic(DynamicOptions const& options, gi::Report& report);

} // namespace viewer
