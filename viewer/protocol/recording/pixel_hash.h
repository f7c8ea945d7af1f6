#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace viewer {

/// XXH64 (Collet, xxHash specification 0.1.1, BSD licence) of the bytes of a picture, to tell whether two pictures
/// are the same bit by bit. Chain several views of a frame by giving the hash so far as the seed. About 8 MB per
/// ms.
std::uint64_t pixel_hash(std::span<std::byte const> bytes, std::uint64_t seed = 0);

} // namespace viewer
