#pragma once
// The random numbers of a path, the same on every device.

#include "gi/core/rqmc.h"

#include <array>

namespace gi {

/// Key of a picture.
GI_FN inline std::uint32_t random_key(std::uint64_t seed)
{
    return std::uint32_t(seed) ^ std::uint32_t(seed >> 32);
}

/// Random numbers of pixel `id` = y * width + x. Neighbours use different strata, so that means over windows of
/// pixels have less noise. @param key  of the picture  @param index  of the path
GI_FN inline RqmcStream pixel_stream(std::uint32_t key, std::uint32_t id, std::uint32_t width, std::uint32_t index)
{
    constexpr std::uint32_t kTile = 4; // pixels per side, as sixteen streams share a seed
    std::uint32_t const x = id % width, y = id / width;
    RqmcStream stream{hash_words(key, y / kTile * width + x / kTile), index};
    stream.place = y % kTile * kTile + x % kTile;
    return stream;
}

/// The decisions at one vertex of a path, each with its own random numbers.
enum class PathDimension : std::uint32_t {
    axis,
    lobe,
    lobe_u,
    lobe_v,
    roulette,
    light_point,
    light_sample_pick,
    shadow, ///< from here on plain pseudo-random, not low-discrepancy
    cone,
    cache,
    count
};
/// The camera uses the first two dimensions.
GI_FN inline std::uint32_t dimension_of(std::uint32_t vertex, PathDimension d)
{
    return vertex * std::uint32_t(PathDimension::count) + 2 + std::uint32_t(d);
}

/// The numbers of all decisions at a vertex: the same values as one by one, computed as a vector.
struct VertexNumbers {
    static constexpr std::size_t kRoom = 8;
    static_assert(std::size_t(PathDimension::shadow) <= kRoom);
    alignas(32) std::array<float, kRoom> u;

    VertexNumbers() = default;
    VertexNumbers(RqmcStream const& random, std::uint32_t vertex)
    {
        std::uint32_t const first = dimension_of(vertex, PathDimension{});
        for (std::uint32_t d = 0; d < kRoom; ++d) u[d] = random.sample(first + d);
    }
    float operator[](PathDimension d) const { return u[std::size_t(d)]; }
    /// Returns this number and the next.
    vec2 pair(PathDimension d) const { return {u[std::size_t(d)], u[std::size_t(d) + 1]}; }
};

} // namespace gi
