#pragma once
// The means of an accumulator in a memory space, while kernels add paths to them.

#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"
#include "gi/render/add_samples.h"

namespace gi {

template <Space S>
class SumsOn {
public:
    /// Copies the means, to which paths will be added. All pixels have as many paths.
    void take(Accumulator const& sums)
    {
        if (means_.size() != sums.pixels.size()) means_ = Buffer<PixelMeans, S>(sums.pixels.size());
        paths_ = sums.paths_of(0);
        if (paths_ > 0)
            copy_bytes(S, means_.view().data, Space::host, sums.pixels.data(), means_.size() * sizeof(PixelMeans));
    }
    /// Adds one path of every pixel.
    void add(View<PathSample const> samples)
    {
        launch(S, "add samples", means_.size(), AddSamples{samples, {means_.view(), paths_}});
        ++paths_;
    }
    View<PixelMeans> means() { return means_.view(); } ///< for kernels that add paths themselves
    /// Copies the means back, which are valid if there are any paths; the caller counts them.
    void give(Accumulator& sums) const
    {
        copy_bytes(Space::host, sums.pixels.data(), S, means_.view().data, means_.size() * sizeof(PixelMeans));
    }

private:
    Buffer<PixelMeans, S> means_;
    std::uint32_t paths_ = 0;
};

} // namespace gi
