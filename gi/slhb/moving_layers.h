#pragma once
// Layers of what moves, beside those of what stays: the columns that something moving is in are written anew
// behind all others, merged in depth order, and found there (Yu 2012, sec. 5.4: appended to the lists). So each
// column is what a buffer built from everything would have, and queries know no difference; what it costs follows
// from what moves, not from the scene.

#include "gi/slhb/axis_pool.h"
#include "gi/slhb/cut_outs.h"

#include <span>

namespace gi {

class MovingLayers {
public:
    struct Source {
        TriangleSoup const& soup;
        std::size_t first; ///< triangle that moves; all after it do
        CutOuts const& cut_outs;
        std::uint32_t most_layers; ///< per texel, as in fill_hit_buffer
    };

    /// Puts the layers of now in the place of those of before. After fill_pool, call forget() first.
    /// @param cut_seeds  per axis, those that its static buffer was built with
    /// Throws InputError where 32-bit indices do not suffice.
    void append(Source const& source, std::span<std::uint32_t const> cut_seeds, AxisPool& pool);
    /// The pool has been filled afresh.
    void forget() { static_layers_ = kNone; }

    std::uint64_t layers() const { return layers_; } ///< of what moves, in all axes
    std::uint64_t lost() const { return lost_; } ///< beyond most_layers, in columns that something moving is in

private:
    static constexpr std::size_t kNone = ~std::size_t(0);

    /// What one axis has.
    struct Axis {
        std::vector<std::uint32_t> texels; ///< that something moving is in
        std::vector<std::uint32_t> ends;   ///< of their columns in `layers`
        std::vector<HitLayer> layers;
        std::uint64_t moving = 0, lost = 0;
    };
    static void merge(Source const& source, std::uint32_t cut_seed, AxisPool const& pool, std::size_t a,
                      Axis& out);

    std::vector<Axis> axes_;
    std::size_t static_layers_ = kNone; ///< of the pool
    std::uint64_t layers_ = 0, lost_ = 0;
};

} // namespace gi
