#pragma once
#include "study/analysis/analysis.h"

namespace study {

/// The main results, one sentence per block: a section of HTML, empty without results.
std::string findings(Analysis const& analysis);

} // namespace study
