#pragma once
// Sums over the paths of two pictures that are equal in most pixels: for the second, sums are kept only for pixels
// whose paths ever differed from the first picture's. The results equal those of two Accumulators bit for bit.

#include "gi/render/accumulator.h"

#include <span>

namespace gi {

class PairSums {
public:
    /// Removes all paths; reuses the memory if the size is the same.
    void start(int width, int height);

    /// Adds one path to every pixel of both pictures. @param first  paths of the first picture, one per pixel
    /// @param pixels, second  pixels in which the second picture has a different path, and those paths;
    ///   each pixel at most once
    void add(std::span<PathSample const> first, std::span<std::uint32_t const> pixels,
             std::span<PathSample const> second);
    std::uint32_t paths() const { return first_.paths; }

    Picture first(World const& world, PictureLayers layers) const { return first_.picture(world, layers); }
    /// @param picture  first(), of the same world and layers
    void make_second(World const& world, Picture& picture) const;

private:
    Accumulator first_{0, 0};
    /// Per pixel: index of its sums of the second picture; kNone = same as first.
    std::vector<std::uint32_t> slot_;
    std::vector<std::uint32_t> pixels_; ///< per slot
    std::vector<PixelMeans> second_;    ///< per slot
    std::vector<std::uint32_t> other_;  ///< per slot: index of its own path in this pass; kNone = same as first
};

} // namespace gi
