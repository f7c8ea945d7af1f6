#pragma once
#include "gi/core/report.h"

#include <nlohmann/json.hpp>

namespace viewer {

/// stages (s), counts, losses (count, first place), peak memory (bytes).
nlohmann::ordered_json to_json(gi::Report const& report);
/// One line per loss on stderr. @param whose  stands before what was lost; empty = the command's
void print_losses(gi::Report const& report, std::string const& whose = "");
/// With a newline at the end; names that are not UTF-8 are repaired.
std::string to_text(nlohmann::ordered_json const& json);

} // namespace viewer
