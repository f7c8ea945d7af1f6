#pragma once
// Checks whether a frame on disk is the one that would be rendered now.

#include "gi/image_io/picture.h"
#include "viewer/offline/render_options.h"

#include <cstdint>
#include <map>
#include <string>

namespace viewer {

/// Metadata of a frame: those of a picture, its number, and what identifies the render that it belongs to: stop
/// condition, the requested layers, and a fingerprint of world, camera and settings.
/// @param motion  fingerprint of the motion while the shutter is open; 0 = none
std::map<std::string, std::string> frame_metadata(RenderOptions const& options, gi::RenderSettings const& settings,
                                                  gi::RenderResult const& result, int frame,
                                                  std::uint64_t fingerprint, std::uint64_t motion);

/// First difference between a frame on disk and the wanted one ("its seed is 1, not 0"); empty = none.
/// @param wanted  from frame_metadata; values that are known only after rendering are not compared
std::string difference(gi::Picture const& there, std::map<std::string, std::string> const& wanted);

} // namespace viewer
