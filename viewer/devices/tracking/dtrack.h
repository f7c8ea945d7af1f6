#pragma once
// ART DTrack's ASCII packets (DTrack2 and DTRACK3 manuals, appendix "Output of measurement data via Ethernet"):
// lines of an identifier and values.
//
//   fr 21753                                    frame counter
//   ts 39596.024831                             s since midnight (UTC), when the cameras flashed
//   6dcal 2                                     number of calibrated bodies
//   6d 1 [id qu][x y z a b c][b0 .. b8]         bodies that are seen
//   6df 1 [id qu bt][x y z a b c][b0 .. b8]     flysticks, older form
//   6df2 2 1 [id qu nbt nct][x y z][b0 .. b8][bt.. ct..]
//
// Positions in mm, b0..b8 the rotation column by column; the angles (degrees) repeat it and are not read.

#include "viewer/devices/tracking/tracker_sample.h"

#include <string_view>

namespace viewer {

/// Any bytes; never throws for what they are. Bodies are called "0", "1", ... and flysticks "flystick0", ...
/// measured_s is the time stamp where there is one. Positions become m, axes stay the tracker's. A body with
/// quality -1 or a matrix of zeros is not visible. A matrix that is no rotation (to 1 %) makes its line malformed
/// from there on; lines of other identifiers are ignored and counted.
TrackerPacket parse_dtrack(std::string_view packet);

/// The packet that a controller would send of these samples: fr, ts where samples have a time, 6dcal, 6d, 6df2.
/// Bodies whose names are not of those forms are left out.
std::string format_dtrack(std::vector<TrackerSample> const& samples, std::uint64_t frame);

} // namespace viewer
