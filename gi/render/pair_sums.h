#pragma once
// Sums over the paths of two pictures that are equal in most pixels: of the second only those are kept that ever
// had another path than the first. What comes out is what two Accumulators would give, bit for bit.

#include "gi/render/accumulator.h"

#include <span>

namespace gi {

class PairSums {
public:
    /// Forgets all paths; memory of the same size is used again.
    void start(int width, int height);

    /// A path for every pixel of both. @param first  of the first picture, one per pixel
    /// @param pixels, second  where the second picture has another path, and that; each pixel at most once
    void add(std::span<PathSample const> first, std::span<std::uint32_t const> pixels,
             std::span<PathSample const> second);
    std::uint32_t paths() const { return first_.paths; }

    Picture first(World const& world, PictureLayers layers) const { return first_.picture(world, layers); }
    /// @param picture  first(), of the same world and layers
    void make_second(World const& world, Picture& picture) const;

private:
    Accumulator first_{0, 0};
    std::vector<std::uint32_t> slot_;   ///< per pixel: where its sums of the second picture are; kNone = as first
    std::vector<std::uint32_t> pixels_; ///< per slot
    std::vector<PixelSums> second_;     ///< per slot
    std::vector<std::uint32_t> other_;  ///< per slot: which of the paths of a pass is its own; kNone = as first
};

} // namespace gi
