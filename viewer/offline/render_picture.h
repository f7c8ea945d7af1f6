#pragma once
// Steps from a rendered picture to files, shared by single pictures and frames.

#include "gi/image_io/picture_file.h"
#include "gi/scene/model/world.h"
#include "viewer/offline/render_options.h"

#include <functional>

namespace viewer {

/// Prints "note: TEXT" on stderr.
void say(std::string const& text);
/// Turns off all notes of this process; called once by ranks of a cluster that do not lead.
void be_silent();

/// Filters the picture. @return note to the user; empty = none
std::string denoise(gi::Picture& picture, gi::DenoiseSettings const& settings, gi::Report& report);
/// Keeps only color (with alpha, if any) and the requested layers.
void keep_layers(RenderOptions const& options, gi::Picture& picture);
void save_exr(RenderOptions const& options, std::string const& file, gi::PictureRows const& picture,
              gi::Report& report, gi::ExrAttributes const& attributes = {});
/// Layer "color", tone-mapped by --exposure and --tone: 8 bits of red, green, blue and, if present, alpha.
std::vector<unsigned char> display_bytes(RenderOptions const& options, gi::Picture const& picture);

} // namespace viewer
