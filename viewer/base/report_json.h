#pragma once
// Reports (gi/core/report.h) as JSON and as messages.

#include "gi/core/report.h"

#include <nlohmann/json.hpp>

namespace viewer {

/// Stage times (s), counts, losses (count and first place), what the device was asked to do by the whole program,
/// and peak memory (bytes).
nlohmann::ordered_json to_json(gi::Report const& report);
/// Prints one line per loss on stderr; what begins with "in doubt: " is used, and not called lost. @param whose  prefix of each loss, e.g. "rank 1: "; empty = this process
void print_losses(gi::Report const& report, std::string const& whose = "");
/// Serialises with a newline at the end; invalid UTF-8 is replaced.
std::string to_text(nlohmann::ordered_json const& json);

} // namespace viewer
