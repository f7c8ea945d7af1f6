#pragma once
#include "study/analysis/analysis.h"

namespace study {

/// What came out, in a sentence per block: a section of HTML, empty where nothing did.
std::string findings(Analysis const& analysis);

} // namespace study
