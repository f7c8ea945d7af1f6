#pragma once
// Poses in OSC 1.0 packets: single messages and bundles. Which addresses and arguments count is a list of
// patterns.

#include "viewer/devices/tracking/tracker_sample.h"

#include <span>

namespace viewer {

/// `path`: segments that must be equal, one of which may be <body>: what stands there names the body.
/// `arguments`: one word per argument, those in [ ] may be missing:
///   x y z          position in units of the tracker
///   qx qy qz qw    unit quaternion (to 5 %)
///   yaw pitch roll degrees, R = Ry(yaw) Rx(pitch) Rz(roll), in the sender's axes with y up
///   time           s on the sender's clock; without it the time tag of the bundle counts, if it has one
///   frame          counter of the sender for this body
///   buttons        bits; visible: 0 = the body is not seen now; quality: 0..1
///   body           name, text or whole number; _ anything
struct OscPattern {
    std::string path, arguments;

    bool operator==(OscPattern const&) const = default;
};

/// /tracker/<body>/pose, position, rotation, euler, pose_euler, buttons; /VMC/Ext/{Hmd,Con,Tra}/Pos;
/// /tracking/trackers/<body>/{position,rotation}. Listed in docs/trackers.md.
std::vector<OscPattern> const& default_osc_patterns();

/// Throws InputError where a pattern makes no sense.
void check(OscPattern const& pattern);

/// Any bytes; never throws for what they are. Positions and rotations of one body in one bundle become one sample.
TrackerPacket parse_osc(std::span<unsigned char const> packet,
                        std::vector<OscPattern> const& patterns = default_osc_patterns());

/// A bundle of /tracker/<body>/pose messages (x y z qx qy qz qw time frame buttons visible).
std::vector<unsigned char> format_osc(std::vector<TrackerSample> const& samples, std::uint64_t frame);

} // namespace viewer
