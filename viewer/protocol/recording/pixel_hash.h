#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace viewer {

/// XXH64 (Collet, xxHash specification 0.1.1, BSD licence) of the bytes of a picture, to compare two pictures bit
/// by bit. To combine several views, pass the hash so far as the seed. About 8 MB per ms.
std::uint64_t pixel_hash(std::span<std::byte const> bytes, std::uint64_t seed = 0);

} // namespace viewer
