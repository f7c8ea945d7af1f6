#pragma once
// Results of a power study as table, JSON, text and HTML page.

#include "study/power/power_study.h"
#include "study/tables/table.h"

namespace study {

Table power_table(PowerStudy const& study, PowerSettings const& settings);
std::string power_json(PowerStudy const& study, PowerSettings const& settings);
/// Aligned text for a terminal.
std::string power_text(PowerStudy const& study, PowerSettings const& settings);
/// One HTML page with power against participants, a curve for each size of the effect.
std::string power_page(Script const& script, PowerStudy const& study, PowerSettings const& settings,
                       std::string const& program);

} // namespace study
