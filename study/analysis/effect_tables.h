#pragma once
#include "study/analysis/result_tables.h"

namespace study {

/// Tests of conditions and of groups of participants.
ResultTable effects_table(Analysis const& analysis);
ResultTable group_differences_table(Analysis const& analysis);

} // namespace study
