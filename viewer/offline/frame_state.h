#pragma once
// Whether a frame on disk is the one that would be rendered now.

#include "gi/image_io/picture.h"
#include "viewer/offline/render_options.h"

#include <cstdint>
#include <map>
#include <string>

namespace viewer {

/// Metadata of a frame: those of a picture, its number, and what tells whether it belongs to a render: when it was
/// to stop, the layers that were asked for, and a fingerprint of world, camera and settings.
/// @param motion  the same of what happens while the shutter is open; 0 = nothing
std::map<std::string, std::string> frame_metadata(RenderOptions const& options, gi::RenderSettings const& settings,
                                                  gi::RenderResult const& result, int frame,
                                                  std::uint64_t fingerprint, std::uint64_t motion);

/// What of a frame on disk differs from the one that is wanted ("its seed is 1, not 0"); empty = nothing.
/// @param wanted by frame_metadata; what is only known once it is rendered is not compared
std::string difference(gi::Picture const& there, std::map<std::string, std::string> const& wanted);

} // namespace viewer
