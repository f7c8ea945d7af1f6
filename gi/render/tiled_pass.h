#pragma once
// A pass of a render over the tiles of a picture, in parallel. Where it is interrupted, tiles keep their paths
// (Accumulator::further), and a later pass continues from there.

#include "gi/render/accumulator.h"
#include "gi/render/pass_stop.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

class TiledPass {
public:
    static constexpr int kTile = 16; ///< px

    class Tile {
    public:
        int index;
        int left, right, top, bottom; ///< px; right and bottom are behind the last ones

        /// Calls trace(k) for every path k of the pass, from 0, that the tile lacks, until the pass is given up.
        /// Where trace() throws Interrupted, the tile lacks that path still.
        template <class F>
        void for_paths(F const& trace) const
        {
            try {
                for (std::uint32_t& k = done_; k < paths_ && !stop_.given_up(); ++k) trace(k);
            } catch (Interrupted const&) {
            }
        }

    private:
        friend TiledPass;
        Tile(TiledPass& pass, int t)
            : index(t),
              left(t % pass.columns_ * kTile),
              right(std::min(left + kTile, pass.sums_.width)),
              top(t / pass.columns_ * kTile),
              bottom(std::min(top + kTile, pass.sums_.height)),
              paths_(pass.paths),
              done_(pass.done_[std::size_t(t)]),
              stop_(pass.stop_)
        {
        }
        std::uint32_t paths_;
        std::uint32_t& done_;
        PassStop const& stop_;
    };

    /// @param count  paths of every pixel; no fewer than it has further ones
    TiledPass(Accumulator& sums, std::uint32_t count, PassStop const& stop)
        : paths(count),
          sums_(sums),
          stop_(stop),
          columns_((sums.width + kTile - 1) / kTile),
          done_(std::size_t(columns_) * std::size_t((sums.height + kTile - 1) / kTile))
    {
        for (std::size_t t = 0; t < done_.size() && !sums.further.empty(); ++t) {
            Tile const tile(*this, int(t));
            done_[t] = sums.further[first_pixel(tile, tile.top)];
        }
    }

    /// Calls trace(tile) for all tiles.
    template <class F>
    void run(F const& trace)
    {
        tbb::parallel_for(0, int(done_.size()), [&](int t) { trace(Tile(*this, t)); });
    }

    bool given_up() const { return stop_.given_up(); }
    /// Paths that all tiles have.
    std::uint32_t done() const { return *std::ranges::min_element(done_); }
    /// Call instead of run() if `n` paths of all tiles were traced in another way.
    void set_done(std::uint32_t n) { std::ranges::fill(done_, n); }
    /// Call it last: counts the paths. Throws Interrupted if the pass was given up.
    void end()
    {
        if (std::ranges::all_of(done_, [&](std::uint32_t n) { return n >= paths; })) {
            sums_.further.clear();
            sums_.paths += paths;
            return;
        }
        keep();
        throw Interrupted();
    }

    std::size_t pixels() const { return sums_.pixels.size(); }
    std::uint32_t const paths;

private:
    std::size_t first_pixel(Tile const& t, int y) const
    {
        return std::size_t(y) * std::size_t(sums_.width) + std::size_t(t.left);
    }
    void keep()
    {
        if (sums_.paths == 0 && std::ranges::none_of(done_, [](std::uint32_t n) { return n > 0; })) return;
        sums_.further.resize(sums_.pixels.size());
        for (std::size_t t = 0; t < done_.size(); ++t) {
            Tile const tile(*this, int(t));
            for (int y = tile.top; y < tile.bottom; ++y) {
                auto const at = std::ptrdiff_t(first_pixel(tile, y));
                std::fill_n(sums_.further.begin() + at, tile.right - tile.left, done_[t]);
                if (sums_.paths + done_[t] == 0)
                    std::fill_n(sums_.pixels.begin() + at, tile.right - tile.left, PixelMeans{});
            }
        }
    }

    Accumulator& sums_;
    PassStop const& stop_;
    int columns_;
    std::vector<std::uint32_t> done_; ///< paths of each tile
};

} // namespace gi
