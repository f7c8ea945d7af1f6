#pragma once
// Result tables of hierarchical models and of tests between conditions and groups.

#include "study/analysis/result_tables.h"

namespace study {

/// Scores with observers as random effects.
ResultTable hierarchy_table(Analysis const& analysis);
/// Tests of conditions and of groups of participants.
ResultTable effects_table(Analysis const& analysis);
ResultTable group_differences_table(Analysis const& analysis);

} // namespace study
