#pragma once
// Steps from the paths of a picture to its files, of single pictures and of frames.

#include "gi/image_io/picture_file.h"
#include "viewer/offline/render_options.h"

namespace viewer {

/// Filters the picture. @return note to the user; empty = none
std::string denoise(gi::Picture& picture, gi::DenoiseSettings const& settings, gi::Report& report);
/// Makes the fourth channel of color, as files have it, the layer alpha.
void split_alpha(gi::Picture& picture);
/// Keeps only color (with alpha, if any) and the requested layers.
void keep_layers(RenderOptions const& options, gi::Picture& picture);
void save_exr(RenderOptions const& options, std::string const& file, gi::PictureRows const& picture,
              gi::Report& report, gi::ExrAttributes const& attributes = {});
/// Layer "color", tone-mapped by --exposure and --tone: 8 bits of red, green, blue and, if present, alpha.
std::vector<unsigned char> display_bytes(RenderOptions const& options, gi::Picture const& picture);
/// Writes --out and --png. Makes the picture while it writes it, as that takes half of the memory.
/// @param stop  throws Interrupted; null = never, and the picture is not compressed,
///   which would take longer than all else
void write_files(RenderOptions const& options, gi::PictureRows const& picture, gi::StopRequest const* stop,
                 gi::Report& report);

} // namespace viewer
