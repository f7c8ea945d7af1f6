#pragma once
// Layers of what moves, beside those of what stays: the columns that something moving is in are written anew
// behind all others, merged in depth order, and found there (Yu 2012, sec. 5.4: appended to the lists). So each
// column is what a buffer built from everything would have, and queries know no difference; what it costs follows
// from what moves, not from the scene.

#include "gi/methods/slhb/hit_buffer/axis_pool.h"
#include "gi/methods/slhb/hit_buffer/cut_outs.h"

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

    /// Puts the layers of now into the axes that follow, where they are not there yet; takes those of before out
    /// of all others. After fill_pool, call forget() first.
    /// @param cut_seeds  per axis, those that its static buffer was built with  @param followed  per axis: 0 = not
    /// @return layers that were lost: beyond most_layers, in columns that something moving is in
    /// Throws InputError where 32-bit indices do not suffice.
    std::uint64_t append(Source const& source, std::span<std::uint32_t const> cut_seeds,
                         std::span<std::uint8_t const> updated, AxisPool& pool);
    /// No axis has it as it is now.
    void moved()
    {
        for (Axis& a : axes_) a.current = false;
    }
    /// The pool has been filled afresh.
    void forget()
    {
        static_layers_ = kNone;
        moved();
    }

    std::uint64_t layers() const { return layers_; } ///< of what moves, in all axes

private:
    static constexpr std::size_t kNone = ~std::size_t(0);

    /// What one axis has.
    struct Axis {
        std::vector<std::uint32_t> texels; ///< that something moving is in
        std::vector<std::uint32_t> ends;   ///< of their columns in `layers`
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
