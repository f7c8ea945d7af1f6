#pragma once
// Pictures of a printed board by a camera that is known, to try out calibration without one.

#include "ar/markers/marker_map.h"

#include <filesystem>

namespace viewer {

/// FOLDER/01.png, 02.png, ...: 8 bits, sRGB, with blur and noise, always the same. FOLDER/truth.yaml: the camera.
/// @throws InputError the folder exists or cannot be made
void write_board_views(std::filesystem::path const& folder, ar::CharucoBoard board, int count);

} // namespace viewer
