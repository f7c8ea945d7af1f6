#pragma once
// The radiance cache of kernels between passes and frames: its memory, its unit, and when it grows.

#include "gi/kernel/launch.h"
#include "gi/methods/paths/kernels/cache_kernels.h"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

namespace gi {

template <Space S>
class KernelCache {
public:
    /// @param radius  of the world, m  @param most_bytes  of the cells  @param paths  of a pass
    KernelCache(float radius, std::size_t most_bytes, std::size_t paths)
        : most_cells_(std::max(kLeastCells, std::bit_floor(most_bytes / sizeof(CacheCell)))),
          cells_(std::clamp(std::bit_ceil(2 * paths), kLeastCells, most_cells_)),
          shift_(cell_shift(radius))
    {
        clear();
    }

    /// Empties it, as light or geometry has changed.
    void clear()
    {
        zero(cells_);
        zero(count_);
        passes_ = 0;
        unit_ = 0;
        empty_ = true;
    }
    bool empty() const { return empty_; } ///< nothing was taught since it was cleared

    /// For the paths of a view. @param paths  at most
    CacheView lend(std::size_t paths)
    {
        if (notes_.size() < notes_of_path_ * paths) {
            notes_ = {};
            notes_ = ColumnBuffer<CacheNoteOnWay, S>(notes_of_path_ * paths);
        }
        fill_bytes(S, count_.view().data, 0, sizeof(std::uint32_t));
        return view();
    }
    /// The paths of the view have ended. @param samples  of all pixels
    void learn(View<PathSample const> samples)
    {
        if (unit_ == 0) choose_unit(samples);
        launch(S, "notes of the radiance cache", notes_.size(), LearnNotes{view(), samples});
        empty_ = false;
    }
    void end_pass() { ++passes_; }
    /// Between passes: grows if it is half full. Waits for the device.
    void grow()
    {
        std::vector<std::uint32_t> const counts = download(count_);
        taken_ = counts[3];
        refused_ += std::uint64_t(counts[1]) + counts[2];
        if (counts[2] > 0) notes_of_path_ = std::min(2 * notes_of_path_, kMostNotesOfPath);
        fill_bytes(S, count_.view().data, 0, 3 * sizeof(std::uint32_t));
        if (2 * std::size_t(taken_) <= cells_.size() || 2 * cells_.size() > most_cells_) return;
        std::size_t const larger = 4 * cells_.size() <= most_cells_ ? 4 * cells_.size() : 2 * cells_.size();
        Buffer<CacheCell, S> old;
        try {
            old = std::exchange(cells_, Buffer<CacheCell, S>(larger));
        } catch (std::bad_alloc const&) {
            most_cells_ = cells_.size(); // it stays as it is
            return;
        }
        zero(cells_);
        zero(count_);
        launch(S, "cells that move", old.size(), MoveCells{std::as_const(old).view(), view()});
    }

    std::size_t cells() const { return taken_; }
    std::size_t bytes() const { return cells_.size() * sizeof(CacheCell); }
    std::uint64_t refused() const { return refused_; } ///< notes for which there was no room

private:
    static constexpr std::size_t kLeastCells = std::size_t(1) << 18; // 16 MiB
    static constexpr std::size_t kMostNotesOfPath = 12;

    template <class T>
    static void zero(Buffer<T, S>& b)
    {
        fill_bytes(S, b.view().data, 0, b.size() * sizeof(T));
    }
    CacheView view()
    {
        return {cells_.view(), unit_ > 0 ? unit_ : 1, shift_, std::uint32_t(least_level(passes_)), notes_.view(),
                count_.view()};
    }
    /// The median of what the notes bring, as a power of two.
    void choose_unit(View<PathSample const> samples)
    {
        Buffer<std::uint32_t, S> exponents(256);
        zero(exponents);
        launch(S, "exponents of notes", notes_.size(), CountExponents{view(), samples, exponents.view()});
        std::vector<std::uint32_t> const counts = download(exponents);
        std::uint64_t all = 0, sum = 0;
        for (std::uint32_t const n : counts) all += n;
        if (all == 0) return; // nothing was brought: it is chosen later
        int exponent = 0;
        while (exponent < 255 && 2 * (sum += counts[std::size_t(exponent)]) < all) ++exponent;
        unit_ = std::ldexp(1.0f, std::clamp(exponent - 127, -60, 60));
    }

    std::size_t most_cells_;
    Buffer<CacheCell, S> cells_;
    Buffer<std::uint32_t, S> count_{4}; ///< see CacheView
    ColumnBuffer<CacheNoteOnWay, S> notes_;
    std::size_t notes_of_path_ = 3; ///< on average; what has no room is counted, and later passes have more
    vec3 shift_;
    float unit_ = 0; ///< 0 = not chosen
    bool empty_ = true;
    std::uint32_t passes_ = 0, taken_ = 0;
    std::uint64_t refused_ = 0;
};

} // namespace gi
