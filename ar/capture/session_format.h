#pragma once
// Recorded sessions: what a camera delivered, bit by bit, and when. A folder with three files:
//   session.json  what was recorded: camera, calibration file, when; and, once it was closed in order, how many
//                 frames there are and how many did not fit
//   frames.bin    the bytes of one frame after the other: plane by plane, row by row without gaps (mjpeg: as it
//   came) index.jsonl   a line for each frame, in the order of their bytes, and for each setting of controls:
//     {"frame":{"sequence":7,"captured_s":1.5,"arrived_s":1.52,"origin":"sensor","exposure":[time_s,gain,red,blue],
//      "format":"nv12","size_px":[640,480],"at":0,"bytes":460800,"sum":"1234abcd"},"crc32":"89abcdef"}
//     {"controls":{"exposure_time_s":0.01},"crc32":"..."}
// Times are of the steady clock of the machine that recorded. `at` and `bytes` are the frame's place in
// frames.bin, `sum` is the CRC-32 of these bytes, `crc32` that of the line up to its comma. A frame's bytes are
// written before its line: a process that is killed leaves a session up to its last whole frame.

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
    std::string calibration = {}; ///< file name, as it was given; empty: none
    std::string note = {};
    std::string created = {}; ///< UTC, "2026-05-04T12:30:00Z"; empty becomes now
    struct Finish {
        std::uint64_t frames = 0, lost = 0;
    };
    std::optional<Finish> finished = {}; ///< nothing: the recording was cut off
};

std::string to_json(SessionHeader const& header);
/// @throws gi::InputError with its place: no JSON, no session, one of another version
SessionHeader parse_session_header(std::string const& json, std::string const& name);

/// A line of the index: a frame without its planes, or controls.
struct IndexEntry {
    Frame frame;
    std::uint64_t at = 0, bytes = 0; ///< in frames.bin
    std::uint32_t sum = 0;
    std::optional<Controls> controls = {}; ///< then there is no frame
};

/// Without the line's end.
std::string index_line(IndexEntry const& entry);
/// `text` with its checksum.
std::string with_checksum(std::string const& text_without_brace);
/// Nothing, and why, where the line is not as it was written.
std::optional<IndexEntry> parse_index_line(std::string_view line, std::string& problem);

/// CRC-32 of ISO 3309, as in PNG.
std::uint32_t checksum(std::span<std::uint8_t const> bytes);
/// Bytes of a frame's planes without gaps; for mjpeg 0: any number.
std::uint64_t packed_bytes(PixelFormat format, glm::ivec2 size_px);
/// Makes the planes of a frame of packed bytes, which it then owns through them (no copy of the bytes).
void set_packed_planes(Frame& frame, std::vector<std::uint8_t> bytes);

} // namespace ar
