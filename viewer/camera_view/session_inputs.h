#pragma once
// Lists the input files of a session: none may be overwritten while it runs,
// and together they determine its output.

#include "ar/scene/session_file.h"

namespace viewer {

/// The session's own file and the files it references, directly or indirectly: pictures, recordings and videos
/// of both cameras, calibrations, markers, scenes (for a mesh sequence its folder's files), light, proxies,
/// estimated albedos with their textures, and the tracker's display. Missing files are listed by name;
/// cameras and generated scenes have no files. Files referenced by scene files (textures, buffers) are not listed.
/// The order is always the same.
/// @throws gi::InputError, gi::InputError albedos, a display or a pattern that cannot be read
std::vector<std::filesystem::path> files_read_by(ar::Session const& session);

/// Pictures of a folder or numbered pattern, the files of a recording, or the video. Empty for a camera.
std::vector<std::filesystem::path> files_of_source(std::string const& source);

/// Folder of the source's pictures or recording, where composites must not be written; empty if none.
std::filesystem::path folder_of_source(std::string const& source);

} // namespace viewer
