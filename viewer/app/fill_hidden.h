#pragma once
#include <cstdint>
#include <span>

namespace viewer {

/// Fills every hidden pixel from the nearest visible pixel of its row, or from the nearest row with visible
/// pixels. Needed for reprojection: if the head turns faster than kHiddenGuard allows, stretched edges come into
/// view, as at the picture's own border, instead of black.
/// @param hidden  1 per hidden pixel, rows of `width`  @param values  `channels` per pixel
void fill_hidden(std::span<std::uint8_t const> hidden, int width, std::span<float> values, int channels);

} // namespace viewer
