#pragma once
// Synthetic pictures of a printed board from a known camera, to try calibration without a real camera.

#include "ar/markers/marker_map.h"

#include <filesystem>

namespace viewer {

/// Writes FOLDER/01.png, 02.png, ... (8 bits, sRGB, with blur and noise, always the same) and FOLDER/truth.yaml
/// (the camera). @throws InputError if the folder exists or cannot be made
void write_board_views(std::filesystem::path const& folder, ar::CharucoBoard board, int count);

} // namespace viewer
