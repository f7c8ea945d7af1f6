#pragma once
// Which files a session is made of: none of them may be written over while it runs, and together they say what it
// shows.

#include "ar/scene/session_file.h"

namespace viewer {

/// The session's own file, what it names, and what that names: pictures, recordings and videos of both cameras,
/// calibrations, markers, scenes (of a mesh sequence its folder's files), light, proxies, estimated albedos with
/// their textures, and the tracker's display. Only names of what is not there; nothing of cameras and generated
/// scenes. What scene files name themselves (textures, buffers) is not listed. In the same order every time.
/// @throws gi::InputError albedos, a display or a pattern that cannot be read
std::vector<std::filesystem::path> files_read_by(ArSession const& session);

/// Pictures of a folder or of a pattern of numbers, the files of a recording, or the video. Empty: a camera.
std::vector<std::filesystem::path> files_of_source(std::string const& source);

/// Where composites would get among the frames: the folder of pictures, of a pattern's, of a recording. Empty:
/// none.
std::filesystem::path folder_of_source(std::string const& source);

} // namespace viewer
