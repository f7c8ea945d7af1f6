#pragma once
// Transitions between neighbouring trials in a plan, to check the effect of constraints and shuffles.

#include "study/plan/plan.h"

namespace study {

/// Transitions of a factor with one level per trial (or of the correct answers,
/// or procedures) in one pass of a block.
struct Transitions {
    int block = 0, pass = 0;
    std::string subject;
    std::vector<std::string> names;
    std::vector<int> counts; ///< names.size() squared, row by row: [from][to] of neighbouring trials
    double switched = 0;     ///< proportion of neighbours that differ
    double by_chance = 0;    ///< its mean over all orders of the same trials
};

/// Excludes practice and includes catch trials; a break between two trials is ignored.
std::vector<Transitions> find_transitions(Script const& script, Plan const& plan);

} // namespace study
