#pragma once
#include "study/analysis/result_tables.h"

namespace study {

/// Tables of agreement, thresholds, detection, questionnaires and timing, including empty ones.
std::vector<ResultTable> detail_tables(Analysis const& analysis);

} // namespace study
