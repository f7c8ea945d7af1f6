#pragma once
// Poses in OSC 1.0 packets: single messages and bundles. A list of patterns defines
// the recognised addresses and arguments.

#include "viewer/devices/tracking/tracker_sample.h"

#include <span>

namespace viewer {

/// `path`: segments that must match; one of them may be <body>, whose text names the body.
/// `arguments`: one word per argument, those in [ ] are optional:
///   x y z          position in units of the tracker
///   qx qy qz qw    unit quaternion (to 5 %)
///   yaw pitch roll degrees, R = Ry(yaw) Rx(pitch) Rz(roll), in the sender's axes with y up
///   time           s on the sender's clock; without it, the time tag of the bundle is used, if any
///   frame          sender's counter for this body
///   buttons        bits; visible: 0 = the body is not visible now; quality: 0..1
///   axes           all arguments that follow: axes of joysticks, usually -1..1, of which 16 are kept
///   body           name, text or whole number; _ anything
struct OscPattern {
    std::string path, arguments;

    bool operator==(OscPattern const&) const = default;
};

/// /tracker/<body>/pose, position, rotation, euler, pose_euler, buttons, axes; /VMC/Ext/{Hmd,Con,Tra}/Pos;
/// /tracking/trackers/<body>/{position,rotation}. Listed in docs/trackers.md.
std::vector<OscPattern> const& default_osc_patterns();

/// Throws InputError on an invalid pattern.
void check(OscPattern const& pattern);

/// Parses any bytes; never throws because of them. Position and rotation of one
/// body in one bundle become one sample.
TrackerPacket parse_osc(std::span<unsigned char const> packet,
                        std::vector<OscPattern> const& patterns = default_osc_patterns());

/// A bundle of /tracker/<body>/pose messages (x y z qx qy qz qw time frame buttons visible).
std::vector<unsigned char> format_osc(std::vector<TrackerSample> const& samples, std::uint64_t frame);

} // namespace viewer
