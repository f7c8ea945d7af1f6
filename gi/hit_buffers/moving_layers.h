#pragma once
// Layers of dynamic geometry, kept beside the static ones: columns that contain dynamic geometry are rewritten
// behind all others, merged in depth order, and referenced there (Yu 2012, sec. 5.4: appended to the lists). So
// each column equals that of a buffer built from everything, and look-ups work the same; the cost depends on the
// dynamic geometry, not on the scene.

#include "gi/hit_buffers/axis_pool.h"
#include "gi/raster/cut_outs.h"

#include <span>

namespace gi {

class MovingLayers {
public:
    struct Source {
        TriangleSoup const& soup;
        std::size_t first; ///< first dynamic triangle; all later ones are dynamic too
        CutOuts const& cut_outs;
        std::uint32_t most_layers; ///< per texel, as in fill_hit_buffer
    };

    /// Adds the current dynamic layers to the updated axes that lack them, and removes outdated dynamic layers
    /// from all other axes. After fill_pool, call forget() first.
    /// @param cut_seeds  per axis, as used for its static buffer  @param updated  per axis: 0 = not updated
    /// @return number of layers lost (beyond most_layers) in columns that contain dynamic geometry
    /// Throws InputError if 32-bit indices are not enough.
    std::uint64_t append(Source const& source, std::span<std::uint32_t const> cut_seeds,
                         std::span<std::uint8_t const> updated, AxisPool& pool);
    /// Marks the dynamic layers of all axes as outdated.
    void moved()
    {
        for (Axis& a : axes_) a.current = false;
    }
    /// Call after the pool has been filled again.
    void forget()
    {
        static_layers_ = kNone;
        moved();
    }

    std::uint64_t layers() const { return layers_; } ///< of dynamic geometry, in all axes

private:
    static constexpr std::size_t kNone = ~std::size_t(0);

    /// Dynamic columns of one axis.
    struct Axis {
        std::vector<std::uint32_t> texels; ///< that contain dynamic geometry
        std::vector<std::uint32_t> ends;   ///< ends of their columns in `layers`
        std::vector<HitLayer> layers;
        std::uint64_t moving = 0, lost = 0;
        bool current = false;
    };
    static void merge(Source const& source, std::uint32_t cut_seed, AxisPool const& pool, std::size_t a,
                      Axis& out);

    std::vector<Axis> axes_;
    std::size_t static_layers_ = kNone; ///< of the pool
    std::uint64_t layers_ = 0;
};

} // namespace gi
