#pragma once
// study analyze --gaze: what people looked at.

#include "study/gaze/gaze_analysis.h"

#include <CLI/CLI.hpp>

namespace viewer {

struct GazeOptions {
    std::vector<std::string> files; ///< empty: of the records
    std::string method = "ivt", eyes = "mean", display_model, picture, derivatives;
    study::GazeAnalysisSettings settings;
    double min_fixation_ms = -1; ///< below 0: that of the method
    double heat_deg = 1;
    bool follows_rays = false; ///< to objects and materials
    double accuracy_deg = 0.5;
    CLI::Option* given = nullptr; ///< --gaze

    bool any() const { return given->count() > 0; }
};
void add_gaze_options(CLI::App& command, GazeOptions& o);

/// What `analyze` was called with besides.
struct GazeCall {
    std::string dir, script, out;
    std::vector<std::string> exclude;
    bool json = false;
};
int run_gaze(GazeOptions o, GazeCall const& call);

} // namespace viewer
