#pragma once
// The columns of plan.tsv, for its writer and its reader.

#include "study/plan/plan.h"

namespace study {

/// Names in their order. Those of the factors begin at kFirstFactorColumn; a factor whose name another column has
/// is called "factor_NAME".
std::vector<std::string> plan_columns(Script const& script);
inline constexpr std::size_t kFirstFactorColumn = 8;
/// A text in the column "content": one line of at most 60 bytes, without tabs.
std::string plan_content(std::string text);

} // namespace study
