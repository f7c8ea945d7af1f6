#pragma once
// File-format constants shared by Recorder and RecordingReader.

#include "viewer/protocol/recording/recording.h"

#include <array>

namespace viewer {

inline constexpr std::array<std::uint8_t, 8> kRecordingMagic{0x89, 'L', 'W', 'R', '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint32_t kRecordingVersion = 2, kOldestRecordingVersion = 1;
inline constexpr std::size_t kRecordHead = 5, kRecordTail = 4; ///< bytes around a payload
inline constexpr std::size_t kMostPayload = CommandLimits::bytes + 1024;
inline constexpr std::size_t kMostHeaderText = 1 << 20; ///< bytes of each text
enum RecordType : std::uint8_t { kHeaderRecord = 1, kFrameRecord = 2, kEndRecord = 3, kShownRecord = 4 };

} // namespace viewer
