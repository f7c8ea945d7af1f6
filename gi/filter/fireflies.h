#pragma once
// Fireflies: pixels of a picture of few paths whose light is far above that of the surface around them, because a
// rare path found a bright light. Filters would make a square of each.
//
// A pixel's direct or indirect light over the albedo is supported by a window of pixels of similar surfaces if
// enough of these are at least half as bright. Light without support is scaled down, keeping its hue, to the
// largest that is supported. Light that hardly shows beside the surface's other light is left alone, and so are
// pixels whose neighbourhood says nothing, as it is dark or too small. Where the other eye sees the same surface,
// its window has to support the light too. What is taken from a pixel is spread over the similar pixels of a
// wider window: lost, it would darken scenes that few paths light. This blurs, so it is for what a filter reads,
// never for a mean that has to converge.

#include "gi/core/progress.h"
#include "gi/filter/reused_light.h"

#include <vector>

namespace gi {

/// A picture with the layers color, L0, L1, L2, albedo, normal and position.
struct FireflyView {
    Picture const* picture = nullptr;
    /// Source pixels as in ReusedLight: pixels with another picture's light are left alone;
    /// empty = all have their own.
    std::span<std::uint32_t const> from{};
    /// The other eye's picture of the same moment; null = none.
    Picture const* other = nullptr;
    std::span<std::uint32_t const> same{}; ///< per pixel: where `other` sees this surface, or kOwnLight
    StopRequest const* stop = nullptr;     ///< once it is requested, find_fireflies() throws Interrupted
};

/// A pixel to be clamped: factors for its direct and indirect light, 0 to 1.
struct Firefly {
    std::uint32_t pixel;
    float direct, indirect;
};

struct FireflyCounts {
    std::size_t pixels = 0; ///< with a surface
    std::size_t clamped = 0,
                by_eye = 0;      ///< of these; by_eye: of these, those that only the other eye did not support
    double light = 0, moved = 0; ///< luminance of L1 + L2, summed over pixels, and the part of it that is spread

    void add(FireflyCounts const& more);
};

/// Finds the fireflies, in the order of pixels; does not depend on the number of threads.
/// Throws InputError if a layer is missing.
std::vector<Firefly> find_fireflies(FireflyView const& view, FireflyCounts& counts);

/// Scales L1, L2 and the variances, if there are any, spreads what this takes over the similar pixels within 10
/// pixels to each side, and keeps color = L0 + L1 + L2. The sum of light over the albedo stays.
void clamp_fireflies(Picture& picture, std::span<Firefly const> fireflies);

} // namespace gi
