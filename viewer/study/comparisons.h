#pragma once
// What the blocks of an experiment compare with what, and whether it is what was meant.

#include "study/plan/plan.h"

#include <string>
#include <vector>

namespace viewer {

struct Comparisons {
    std::vector<std::string> texts; ///< one line for each block that compares, for people
    /// Levels that grow like the other stimulus towards the end that the script calls easy, levels on both sides
    /// of the other stimulus in adaptive procedures, and crossed factors that the other stimulus does not follow.
    std::vector<std::string> doubts;
};
/// From the trials of a plan. A setting that the other stimulus does not set has the renderer's default.
Comparisons find_comparisons(study::Script const& script, study::Plan const& plan);

} // namespace viewer
