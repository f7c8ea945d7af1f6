#pragma once
// Lengths and positions of markers that are hardly in metres: maps typed in millimetres give poses that fit the
// pictures and are a thousand times too far away.

#include "ar/markers/marker_map.h"
#include "gi/core/report.h"

namespace ar {

/// A sentence for each marker, board and grid that is wider than 3 m, narrower than 5 mm, or more than 100 m from the
/// origin: what it is, and how large in millimetres.
std::vector<std::string> doubts_about(MarkerMap const& map);
/// Counts them. @param where  the map's file
void report_doubts(MarkerMap const& map, std::string const& where, gi::Report& report);

} // namespace ar
