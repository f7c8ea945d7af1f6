#pragma once
// Tables that result_tables() joins.

#include "study/analysis/result_tables.h"

namespace study {

/// Tables of agreement, thresholds, detection, questionnaires and timing, including empty ones.
std::vector<ResultTable> detail_tables(Analysis const& analysis);
/// Scores with observers as random effects.
ResultTable hierarchy_table(Analysis const& analysis);
/// Tests of conditions and of groups of participants.
ResultTable effects_table(Analysis const& analysis);
ResultTable group_differences_table(Analysis const& analysis);

} // namespace study
