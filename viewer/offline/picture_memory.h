#pragma once
// Memory of a picture while it is rendered, known before any of it is spent.

#include <cstdint>
#include <string>

namespace viewer {

struct PictureMemory {
    std::uint64_t sums_bytes = 0;  ///< sums over the paths of all pixels
    std::uint64_t state_bytes = 0; ///< file of an unfinished render
};
PictureMemory picture_memory(int width, int height);

/// "23 bytes", "1.5 MB", "3.1 GB" (decimal).
std::string text_of_bytes(std::uint64_t bytes);

/// Says how much memory a large picture takes. Throws InputError if this machine has not as much available.
void check_picture_memory(int width, int height);

} // namespace viewer
