#pragma once
// The steps from a world to files that single pictures and frames share.

#include "gi/scene/model/world.h"
#include "viewer/offline/render_options.h"

#include <functional>

namespace viewer {

/// "note: TEXT" on stderr.
void say(std::string const& text);
/// Of the ranks of a cluster only the leading one says anything; called once, before.
void be_silent();

/// @return what is to be said about it; empty = nothing
std::string denoise(gi::Picture& picture, gi::DenoiseSettings const& settings, gi::Report& report);
/// Leaves color, with its alpha where it has one, and the layers that were asked for.
void keep_layers(RenderOptions const& options, gi::Picture& picture);
void save_exr(RenderOptions const& options, std::string const& file, gi::Picture const& picture,
              gi::Report& report);
/// "color" as --exposure and --tone have it, 8 bits of red, green, blue and, where it has one, alpha.
std::vector<unsigned char> display_bytes(RenderOptions const& options, gi::Picture const& picture);

} // namespace viewer
