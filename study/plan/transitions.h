#pragma once
// How one trial follows another in a plan: what constraints and shuffles really do.

#include "study/plan/plan.h"

namespace study {

/// Of a factor that has one level a trial (or of the right answers, or procedures) in one pass of a block.
struct Transitions {
    int block = 0, pass = 0;
    std::string subject;
    std::vector<std::string> names;
    std::vector<int> counts; ///< names.size() squared, row by row: [from][to] of neighbouring trials
    double switched = 0;     ///< the share of neighbours that differ
    double by_chance = 0;    ///< what it is on average over all orders of the same trials
};

/// Practice is left out, catch trials count; breaks do not interrupt.
std::vector<Transitions> find_transitions(Script const& script, Plan const& plan);

} // namespace study
