#pragma once
#include "study/plan/plan.h"

#include <string>
#include <vector>

namespace study {

/// What may be meant but seldom is: orders that do not come equally often with so many participants, presentation
/// orders that cannot be balanced within a condition, long sessions, long stretches without a break. One line
/// each.
std::vector<std::string> find_doubts(Script const& script);
/// The same of one participant's plan.
std::vector<std::string> find_doubts(Script const& script, Plan const& plan);

} // namespace study
