#pragma once
// Running means over the paths of every pixel, in path order, so that the picture does not depend on threads, on
// the split into passes, or on interruptions. A checkpoint stores them exactly.

#include "gi/core/huge_pages.h"
#include "gi/image_io/picture_rows.h"
#include "gi/render/path_sample.h"
#include "gi/scene/model/world.h"

#include <memory>
#include <span>
#include <vector>

namespace gi {

/// Running means of one pixel, 92 bytes. Each path moves a mean by its distance from it over the number of paths
/// (Welford 1962), rounded so that the errors of many paths have mean 0. After n paths they are about 2^-24 sqrt(n
/// / 3) of the mean, 1e-5 after 65,536 paths: far less than the noise, which is about 1 / sqrt(n).
struct PixelMeans {
    std::array<vec3, 3> radiance; ///< L0, L1, L2, over all paths
    vec3 deviation; ///< of L0 + L1 + L2: root of the sum of squared deviations from the mean. (The root
                    ///< has the range of the radiance; its square could overflow.)
    vec3 albedo, normal, position; ///< over paths that hit something
    float depth;
    std::uint32_t hits; ///< paths that hit something

    /// @param paths  number of paths, with this one
    void add(PathSample const& s, std::uint32_t paths);
    /// Joins the means of other paths (Chan, Golub and LeVeque 1979). @param mine, theirs  numbers of paths, > 0
    void add(PixelMeans const& s, std::uint32_t mine, std::uint32_t theirs);
    dvec3 color() const { return dvec3(radiance[0]) + dvec3(radiance[1]) + dvec3(radiance[2]); }
};
static_assert(sizeof(PixelMeans) == 92);

/// Allocator that leaves elements uninitialised, for large arrays in which every
/// element is written before it is read.
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

/// Properties of a picture that its world determines, besides the radiance of its paths.
struct PictureShape {
    dvec3 origin{0}; ///< of the world: added to positions
    bool has_alpha = false;
    PictureLayers layers = PictureLayers::all;
};
PictureShape picture_shape(World const& world, PictureLayers layers = PictureLayers::all);

struct Accumulator {
    int width = 0, height = 0;
    std::uint32_t paths = 0;                                   ///< per pixel
    std::vector<PixelMeans, Uninitialised<PixelMeans>> pixels; ///< valid only if has_paths()
    /// Per pixel, paths besides those, of a pass that was interrupted; empty = none.
    std::vector<std::uint32_t> further;
    PathCounts counts;  ///< of all paths so far
    double seconds = 0; ///< spent on these paths
    bool of_several_levels = false; ///< some were traced by programs for other levels of processors

    Accumulator() = default;
    Accumulator(int w, int h) { start(w, h); }
    /// Restarts with no paths; reuses the memory if it is large enough.
    void start(int w, int h)
    {
        width = w;
        height = h;
        pixels.clear(); // so that resizing copies nothing
        resize_on_huge_pages(pixels, std::size_t(w) * std::size_t(h));
        further.clear();
        paths = 0;
        counts = {};
        seconds = 0;
        of_several_levels = false;
    }
    bool has_paths() const { return paths > 0 || !further.empty(); }
    std::uint32_t paths_of(std::size_t pixel) const { return paths + (further.empty() ? 0 : further[pixel]); }
    /// Adds one path of a pixel. @param before  number of paths already added to this pixel
    void add(std::size_t pixel, PathSample const& s, std::uint32_t before)
    {
        if (before == 0) pixels[pixel] = PixelMeans{};
        pixels[pixel].add(s, before + 1);
    }
    /// Adds all paths of an accumulator of the same size, neither of them with further paths. As with any
    /// floating-point sum, the order of additions decides the last bits.
    void add(Accumulator const& other);
    /// Variance of the mean per channel; 0 with fewer than two paths.
    static dvec3 variance_of_mean(PixelMeans const& p, std::uint32_t paths);
    /// Estimated relMSE of the picture: mean over pixels and channels of var(mean) / (m^2 + 0.01),
    /// where m is the mean of 5 x 5 pixels. (With the noisy value of a single pixel as m,
    /// pixels that happen to be dark would dominate.)
    double relative_mse() const;
    /// Makes the picture of the rendered world: positions are absolute;
    /// if the world's background is transparent, "alpha" is the fraction of paths that hit a surface,
    /// and the colours are already multiplied by it (premultiplied).
    Picture picture(World const& world, PictureLayers layers = PictureLayers::all) const;
    /// Some rows of such a picture.
    Picture rows(PictureShape const& shape, int first, int count) const;
    /// Overwrites some pixels of such a picture from other means over the same number of paths. @param at  pixel
    /// indices, one per mean
    void put(World const& world, std::span<std::uint32_t const> at, std::span<PixelMeans const> means,
             Picture& picture) const;
};

/// The picture of finished sums, made while it is read.
PictureRows picture_rows(std::shared_ptr<Accumulator const> const& sums, PictureShape const& shape);

} // namespace gi
