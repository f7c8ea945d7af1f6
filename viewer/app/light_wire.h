#pragma once
// Light of a frame as bytes for other ranks.

#include "viewer/engine/live/live_renderer.h"

namespace viewer {

/// @param light  views by their numbers in the command; cells may be null
std::vector<std::uint8_t> to_bytes(FrameLight const& light);
/// Adds what the bytes have. Cameras are those of the command. Throws std::runtime_error on any other bytes.
void add_light(std::span<std::uint8_t const> bytes, FrameCommand const& command, FrameLight& to);

} // namespace viewer
