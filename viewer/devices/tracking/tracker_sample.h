#pragma once
// A tracker's sample of one body at one time.

#include "viewer/protocol/frame_command.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

/// Numbers of larger magnitude are rejected: trackers do not send them, and integers would no longer be exact.
inline constexpr double kLargestNumber = 1e15;

/// Name of the body of samples that hold the controls of a whole device, not of one of its bodies.
inline constexpr char const* kDeviceControls = "controls";
/// Axes of joysticks and analogs that are read of one body or device.
inline constexpr std::size_t kMostAxes = 16;

/// Parts of a pose that a sample contains; senders may send positions and rotations in separate messages.
enum class SampleParts { pose, position, rotation, buttons };

/// A parsed sample in the tracker's own frame, m. TrackerHub transforms it into the room.
struct TrackerSample {
    std::string body; ///< name used by the sender: "head", "0", "flystick0"
    SampleParts parts = SampleParts::pose;
    RoomPose pose;
    double received_s = 0;                ///< steady clock
    std::optional<double> measured_s;     ///< clock of the sender, any origin
    bool visible = true;                  ///< false: the sender knows the body but does not see it now; no pose
    double quality = 1;                   ///< 0..1, if the sender reports it
    std::optional<std::uint32_t> buttons; ///< bit 0 = first button
    std::vector<double> axes{};           ///< of joysticks, usually -1..1; empty = not sent
    std::optional<std::uint64_t> frame;   ///< sender's counter for this body
};

/// Content of one packet.
struct TrackerPacket {
    std::vector<TrackerSample> samples;
    std::optional<std::uint64_t> frame; ///< sender's counter for whole packets
    std::uint32_t malformed = 0;        ///< lines or messages whose content does not match their type
    std::uint32_t ignored = 0;          ///< well formed, but of no supported type
};

struct TrackerCounts {
    std::uint64_t packets = 0;
    std::uint64_t samples = 0;
    std::uint64_t malformed = 0;         ///< packets, lines or messages
    std::uint64_t ignored = 0;           ///< well formed, but not used
    std::uint64_t lost = 0;              ///< gaps in the sender's counter; late arrivals are subtracted again
    std::uint64_t out_of_order = 0;      ///< arrived after a later one
    std::uint64_t duplicate = 0;         ///< arrived twice
    std::uint64_t restarts = 0;          ///< the sender's counter restarted
    std::uint64_t dropped_by_kernel = 0; ///< the receive buffer was full, because it was polled too rarely
    std::uint64_t connects = 0;          ///< to a server, of protocols with connections
    std::uint64_t disconnects = 0;       ///< connections that ended, because the server was gone or sent nonsense

    bool operator==(TrackerCounts const&) const = default;
};

/// Steady clock, s: the time base of all tracking.
double steady_seconds();

} // namespace viewer
