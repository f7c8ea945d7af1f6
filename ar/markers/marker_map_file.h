#pragma once
// Maps of markers as YAML.
//
//   markers:
//     - {dictionary: DICT_4X4_50, id: 7, side_m: 0.08, position_m: [0, 0, 0], rotation_deg: [-90, 0, 0]}
//   boards:
//     - {squares_x: 8, squares_y: 5, square_m: 0.03, marker_m: 0.022, dictionary: DICT_5X5_100, first_id: 0,
//        legacy_pattern: false, position_m: [0.2, 0, 0], rotation_xyzw: [0, 0, 0, 1]}
//   grids:
//     - {markers_x: 2, markers_y: 3, marker_m: 0.05, gap_m: 0.01, dictionary: DICT_APRILTAG_36h11}
//
// position_m: the origin of the marker, board or grid in the world. rotation_deg: rotations about the world's x,
// then y, then z axis; rotation_xyzw is the rotation as a quaternion; only one of the two may be set. Defaults:
// first_id 0, legacy_pattern false, position 0, no rotation.

#include "ar/markers/marker_map.h"
#include "gi/core/report.h"

#include <filesystem>

namespace ar {

/// @param file name of the file for messages. @throws gi::InputError with file:line:column
MarkerMap parse_marker_map(std::string const& text, std::string const& file);
std::string format_marker_map(MarkerMap const& map);

/// @param report  if not null: doubts about sizes (map_doubts.h). @throws gi::InputError
MarkerMap read_marker_map(std::filesystem::path const& file, gi::Report* report = nullptr);
/// Writes atomically. @throws gi::InputError
void write_marker_map(std::filesystem::path const& file, MarkerMap const& map);

} // namespace ar
