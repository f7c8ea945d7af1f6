#pragma once
#include <cstdint>
#include <span>

namespace viewer {

/// Gives every hidden pixel the values of one beside it that is not: the nearest of its row, or those of the
/// nearest row that has any. For what is shown from another place than where it was rendered for: a head that
/// turns faster than kHiddenGuard allows then brings stretched edges into sight, as it does at the picture's own,
/// and not black.
/// @param hidden  1 per hidden pixel, rows of `width`  @param values  `channels` per pixel
void fill_hidden(std::span<std::uint8_t const> hidden, int width, std::span<float> values, int channels);

} // namespace viewer
