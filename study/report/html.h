#pragma once
#include "study/analysis/result_tables.h"

namespace study {

/// A table with its title and note; column descriptions are shown as hints.
std::string html_of(ResultTable const& table);
std::string_view report_style();

} // namespace study
