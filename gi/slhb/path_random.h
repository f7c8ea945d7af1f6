#pragma once
// The random numbers of a path, the same on every device.

#include "gi/base/rqmc.h"

namespace gi {

/// Of pixel `id` = y * width + x. Neighbours take different strata, so that means over windows of them have less
/// noise. @param key of the picture  @param index of the path
GI_FN inline RqmcStream pixel_stream(std::uint32_t key, std::uint32_t id, std::uint32_t width, std::uint32_t index)
{
    constexpr std::uint32_t kTile = 4; // pixels across, as sixteen streams share a seed
    std::uint32_t const x = id % width, y = id / width;
    RqmcStream stream{hash_words(key, y / kTile * width + x / kTile), index};
    stream.place = y % kTile * kTile + x % kTile;
    return stream;
}

} // namespace gi
