#pragma once
// Sums over the paths of every pixel, in double precision and in path order, so that the picture does not depend
// on threads, on the split into passes, or on interruptions. A checkpoint stores the sums exactly.

#include "gi/core/huge_pages.h"
#include "gi/image_io/picture.h"
#include "gi/render/path_sample.h"
#include "gi/scene/model/world.h"

#include <filesystem>
#include <span>
#include <vector>

namespace gi {

/// Sums of one pixel.
struct PixelSums {
    std::array<dvec3, 3> radiance;  ///< L0, L1, L2
    dvec3 color_squared;            ///< of L0 + L1 + L2, per path
    dvec3 albedo, normal, position; ///< over paths that hit something
    double depth;
    double hits;

    void add(PathSample const& s)
    {
        dvec3 const color = dvec3(s.radiance[0]) + dvec3(s.radiance[1]) + dvec3(s.radiance[2]);
        for (std::size_t i = 0; i < 3; ++i) radiance[i] += dvec3(s.radiance[i]);
        color_squared += color * color;
        if (!s.hit) return;
        albedo += dvec3(s.albedo);
        normal += dvec3(s.normal);
        position += dvec3(s.position);
        depth += double(s.depth);
        hits += 1;
    }
    void add(PixelSums const& s)
    {
        for (std::size_t i = 0; i < 3; ++i) radiance[i] += s.radiance[i];
        color_squared += s.color_squared;
        albedo += s.albedo;
        normal += s.normal;
        position += s.position;
        depth += s.depth;
        hits += s.hits;
    }
};

/// Allocator that leaves elements uninitialised, for large arrays in which every element is written before it is
/// read.
template <class T>
struct Uninitialised : std::allocator<T> {
    static_assert(std::is_trivially_default_constructible_v<T>);
    template <class U>
    struct rebind {
        using other = Uninitialised<U>;
    };
    template <class U>
    void construct(U* at)
    {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... Args>
    void construct(U* at, Args&&... args)
    {
        std::construct_at(at, std::forward<Args>(args)...);
    }
};

enum class PictureLayers : std::uint8_t { all, color_and_depth };

struct Accumulator {
    int width = 0, height = 0;
    std::uint32_t paths = 0;                                 ///< per pixel
    std::vector<PixelSums, Uninitialised<PixelSums>> pixels; ///< valid only if paths > 0
    PathCounts counts;                                       ///< of all paths so far
    double seconds = 0;                                      ///< spent on these paths

    Accumulator() = default;
    Accumulator(int w, int h) { start(w, h); }
    /// Restarts with no paths; reuses the memory if it is large enough.
    void start(int w, int h)
    {
        width = w;
        height = h;
        pixels.clear(); // so that resizing copies nothing
        resize_on_huge_pages(pixels, std::size_t(w) * std::size_t(h));
        paths = 0;
        counts = {};
        seconds = 0;
    }
    /// Adds one path of a pixel. @param before  number of paths already added to this pixel
    void add(std::size_t pixel, PathSample const& s, std::uint32_t before)
    {
        if (before == 0) pixels[pixel] = PixelSums{};
        pixels[pixel].add(s);
    }
    /// Adds all paths of an accumulator of the same size. As with any floating-point sum, the order of additions
    /// decides the last bits.
    void add(Accumulator const& other);
    dvec3 mean(PixelSums const& p) const
    {
        return (p.radiance[0] + p.radiance[1] + p.radiance[2]) / double(paths);
    }
    /// Variance of the mean per channel; 0 with fewer than two paths.
    dvec3 variance_of_mean(PixelSums const& p) const;
    /// Estimated relMSE of the picture: mean over pixels and channels of var(mean) / (m^2 + 0.01), where m is the
    /// mean of 5 x 5 pixels. (With the noisy value of a single pixel as m, pixels that happen to be dark would
    /// dominate.)
    double relative_mse() const;
    /// Makes the picture of the rendered world: positions are absolute; if the world's background is transparent,
    /// "alpha" is the fraction of paths that hit a surface, and the colours are already multiplied by it
    /// (premultiplied).
    Picture picture(World const& world, PictureLayers layers = PictureLayers::all) const;
    /// Overwrites some pixels of such a picture from other sums over the same number of paths. @param at  pixel
    /// indices, one per sum
    void put(World const& world, std::span<std::uint32_t const> at, std::span<PixelSums const> sums,
             Picture& picture) const;
};

/// @param fingerprint  of scene, camera and settings; a checkpoint with another one is refused (InputError)
void save_checkpoint(std::filesystem::path const& file, Accumulator const& a, std::uint64_t fingerprint);
/// Returns false if the file does not exist. Throws InputError if it belongs to another render or is damaged.
bool load_checkpoint(std::filesystem::path const& file, Accumulator& a, std::uint64_t fingerprint);

} // namespace gi
