#pragma once
// Recorded sessions: a camera's frames, bit for bit, and their times. A folder with three files:
//   session.json  camera, calibration file, date; and, once the recording was finished, how many
//                 frames were written and how many were lost
//   frames.bin    the bytes of one frame after the other: plane by plane, row by row without gaps (mjpeg:
//                 unchanged)
//   index.jsonl   a line for each frame, in the order of their bytes, and for each setting of controls:
//     {"frame":{"sequence":7,"captured_s":1.5,"arrived_s":1.52,"origin":"sensor","exposure":[time_s,gain,red,blue],
//      "format":"nv12","size_px":[640,480],"at":0,"bytes":460800,"sum":"1234abcd"},"crc32":"89abcdef"}
//     {"controls":{"exposure_time_s":0.01},"crc32":"..."}
// Times are of the recording machine's steady clock. `at` and `bytes` are the frame's offset and length in
// frames.bin, `sum` is the CRC-32 of these bytes, `crc32` that of the line up to its last comma. A frame's bytes
// are written before its line: after a killed process, the session is valid up to its last complete frame.

#include "ar/capture/frame_source.h"

#include <filesystem>
#include <span>
#include <string_view>

namespace ar {

inline constexpr char const* kSessionFile = "session.json";
inline constexpr char const* kIndexFile = "index.jsonl";
inline constexpr char const* kFramesFile = "frames.bin";
inline constexpr int kSessionVersion = 1;
inline constexpr std::size_t kMostIndexLine = 4096;                      ///< bytes
inline constexpr std::uint64_t kMostFrameBytes = std::uint64_t(1) << 30; ///< of one frame

struct SessionHeader {
    SourceDescription camera;
    std::string calibration = {}; ///< file name as specified; empty: none
    std::string note = {};
    std::string created = {}; ///< UTC, "2026-05-04T12:30:00Z"; empty becomes now
    struct Finish {
        std::uint64_t frames = 0, lost = 0;
    };
    std::optional<Finish> finished = {}; ///< nothing: the recording was cut off
};

std::string to_json(SessionHeader const& header);
/// @throws gi::InputError with its place: not JSON, not a session, another version
SessionHeader parse_session_header(std::string const& json, std::string const& name);

/// A line of the index: a frame without its planes, or controls.
struct IndexEntry {
    Frame frame;
    std::uint64_t at = 0, bytes = 0; ///< in frames.bin
    std::uint32_t sum = 0;
    std::optional<Controls> controls = {}; ///< if set, the entry has no frame
};

/// Formats an entry, without a newline.
std::string index_line(IndexEntry const& entry);
/// Appends the checksum and the closing brace.
std::string with_checksum(std::string const& text_without_brace);
/// Parses a line; if it is damaged, returns nothing and sets `problem`.
std::optional<IndexEntry> parse_index_line(std::string_view line, std::string& problem);

/// CRC-32 of ISO 3309, as in PNG.
std::uint32_t checksum(std::span<std::uint8_t const> bytes);
/// Bytes of a frame's planes without gaps; 0 for mjpeg, whose size varies.
std::uint64_t packed_bytes(PixelFormat format, glm::ivec2 size_px);
/// Sets a frame's planes to packed bytes, which the frame then owns (no copy).
void set_packed_planes(Frame& frame, std::vector<std::uint8_t> bytes);

} // namespace ar
