#pragma once
// ART DTrack's ASCII packets (DTrack2 and DTRACK3 manuals, appendix "Output of measurement data via Ethernet"):
// lines of an identifier and values.
//
//   fr 21753                                    frame counter
//   ts 39596.024831                             s since midnight (UTC), when the cameras flashed
//   6dcal 2                                     number of calibrated bodies
//   6d 1 [id qu][x y z a b c][b0 .. b8]         visible bodies
//   6df 1 [id qu bt][x y z a b c][b0 .. b8]     flysticks, older form
//   6df2 2 1 [id qu nbt nct][x y z][b0 .. b8][bt.. ct..]   buttons, 32 to a word, then axes of joysticks, -1..1
//
// Positions in mm, b0..b8 the rotation column by column; the angles (degrees) are redundant and not read.

#include "viewer/devices/tracking/tracker_sample.h"

#include <string_view>

namespace viewer {

/// Parses any bytes; never throws because of them. Bodies are named "0", "1", ... and flysticks "flystick0",
/// ... measured_s is the time stamp, if any. Positions are converted to m; axes stay the tracker's.
/// A body with quality -1 or a zero matrix is not visible. A matrix that is not a rotation (to 1 %) makes the rest
/// of its line malformed; lines with other identifiers are ignored and counted.
TrackerPacket parse_dtrack(std::string_view packet);

/// The packet that a DTrack controller would send for these samples: fr, ts if samples have a time, 6dcal, 6d,
/// 6df2. Bodies with names of other forms are skipped.
std::string format_dtrack(std::vector<TrackerSample> const& samples, std::uint64_t frame);

} // namespace viewer
