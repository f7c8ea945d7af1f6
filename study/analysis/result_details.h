#pragma once
#include "study/analysis/result_tables.h"

namespace study {

/// Agreement, thresholds, detection, questionnaires, timing; empty ones too.
std::vector<ResultTable> detail_tables(Analysis const& analysis);

} // namespace study
