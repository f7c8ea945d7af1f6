#pragma once
// bench shown: what people see while they move. The viewer's rendering thread and its presenter run in real time, led by
// the recorded path of a head; what is on the screen at some moments is compared with converged pictures of them.

#include "viewer/offline/render_options.h"
#include "viewer/report/table.h"

namespace viewer {

struct ShownOptions {
    RenderOptions scene; ///< scene, camera, sky
    std::string head = "walk", avatar, size = "1280x800", out, truth_filter = "oidn-high";
    std::vector<std::string> settings; ///< KEY=VALUE
    std::vector<std::string> changes;  ///< SECONDS:KEY=VALUE, on the path
    std::string changes_file;          ///< with further ones, one a line
    int eyes = 1, moments = 8, truth_paths = 64;
};

/// Writes shown_K_E.png, truth_K_E.png and error_K_E.png (K moment, E eye) into the folder, and where surfaces are drawn
/// light_K_E.png, at half of their size: white = lit by pictures, light grey = by cells, dark grey = by neither. One row; cells that were
/// not measured are empty. Throws InputError, and Interrupted before there is a result.
BenchTable run_shown(ShownOptions const& options, gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
