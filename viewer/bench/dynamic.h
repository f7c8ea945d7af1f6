#pragma once
// Frames of scenes that move, structure against structure: what each part costs, the error of each frame, and what
// temporal reuse does to it.

#include "viewer/offline/render_options.h"
#include "viewer/report/table.h"

namespace viewer {

struct DynamicOptions {
    RenderOptions render;
    std::vector<std::string> scenes, structures{"static", "rebuilt", "appended", "streamed"};
    std::vector<std::uint32_t> triangles; ///< of rooms in which a figure walks
    std::string out;
    int frames = 24, most_frames = 16;
    double fps = 30;
    std::uint32_t reference_paths = 64; ///< of each frame; 0 = no errors
    int seeds = 1;                      ///< of every sequence; the lag of reuse takes 4 or more
};

struct DynamicResult {
    BenchTable frames, summary;
};

/// Writes tables and pictures to the folder as they come. Throws InputError.
DynamicResult run_dynamic(DynamicOptions const& options, gi::Report& report);

} // namespace viewer
