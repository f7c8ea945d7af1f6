#pragma once
// What a tracker said of one body at one moment.

#include "viewer/protocol/frame_command.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

/// Which parts of a sample its sender gave; a sender may send positions and rotations in messages of their own.
enum class SampleParts { pose, position, rotation, buttons };

/// As parsed: in the tracker's own frame, m. TrackerHub brings it into the room.
struct TrackerSample {
    std::string body; ///< as the sender names it: "head", "0", "flystick0"
    SampleParts parts = SampleParts::pose;
    RoomPose pose;
    double received_s = 0;                ///< steady clock
    std::optional<double> measured_s;     ///< clock of the sender, any origin
    bool visible = true;                  ///< false: the sender has the body, but does not see it now; no pose
    double quality = 1;                   ///< 0..1 where the sender says it
    std::optional<std::uint32_t> buttons; ///< bit 0 = first button
    std::optional<std::uint64_t> frame;   ///< counter of the sender for this body
};

/// What one packet held.
struct TrackerPacket {
    std::vector<TrackerSample> samples;
    std::optional<std::uint64_t> frame; ///< counter of the sender for whole packets
    std::uint32_t malformed = 0;        ///< lines or messages that are not what their name says
    std::uint32_t ignored = 0;          ///< well formed, but nothing that is asked for
};

struct TrackerCounts {
    std::uint64_t packets = 0;
    std::uint64_t samples = 0;
    std::uint64_t malformed = 0;    ///< packets, lines or messages
    std::uint64_t ignored = 0;      ///< well formed, but not for us
    std::uint64_t lost = 0;         ///< by gaps of the sender's counter; those that come late are taken off again
    std::uint64_t out_of_order = 0; ///< came after a later one
    std::uint64_t duplicate = 0;    ///< came twice
    std::uint64_t restarts = 0;     ///< the sender's counter began anew
    std::uint64_t dropped_by_kernel = 0; ///< the receive buffer was full: not polled often enough

    bool operator==(TrackerCounts const&) const = default;
};

/// Seconds of the steady clock, the time base of all tracking.
double steady_seconds();

} // namespace viewer
