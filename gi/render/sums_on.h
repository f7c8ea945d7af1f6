#pragma once
// The means of an accumulator in a memory space, while kernels add paths to them.

#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"
#include "gi/render/add_samples.h"

#include <utility>

namespace gi {

template <Space S>
class SumsOn {
public:
    /// Copies the means, to which paths will be added, unless they are those that were last given to the same
    /// accumulator. All pixels have as many paths.
    void take(Accumulator const& sums)
    {
        bool const kept = std::exchange(given_to_, nullptr) == &sums && paths_ == sums.paths_of(0) &&
                          means_.size() == sums.pixels.size();
        if (means_.size() != sums.pixels.size()) means_ = Buffer<PixelMeans, S>(sums.pixels.size());
        paths_ = sums.paths_of(0);
        if (paths_ > 0 && !kept)
            copy_bytes(S, means_.view().data, Space::host, sums.pixels.data(), means_.size() * sizeof(PixelMeans));
    }
    /// Adds one path of every pixel.
    void add(View<PathSample const> samples)
    {
        launch(S, "add samples", means_.size(), AddSamples{samples, {means_.view(), paths_}});
        ++paths_;
    }
    View<PixelMeans> means() { return means_.view(); } ///< for kernels that add paths themselves
    /// Copies the means back, which are valid if there are any paths; the caller counts them, and nobody else changes
    /// them.
    /// @param paths  of every pixel, with those added
    void give(Accumulator& sums, std::uint32_t paths)
    {
        paths_ = paths;
        given_to_ = &sums;
        copy_bytes(Space::host, sums.pixels.data(), S, means_.view().data, means_.size() * sizeof(PixelMeans));
    }

private:
    Buffer<PixelMeans, S> means_;
    std::uint32_t paths_ = 0;
    Accumulator const* given_to_ = nullptr;
};

} // namespace gi
