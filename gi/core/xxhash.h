#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace gi {

/// XXH64 (Collet, xxHash specification 0.1.1, BSD licence), to compare pictures bit by bit and to find damage in
/// large files. To combine several parts, pass the hash so far as the seed. About 8 MB per ms.
std::uint64_t xxh64(std::span<std::byte const> bytes, std::uint64_t seed = 0);

} // namespace gi
