#pragma once
// Pictures by virtual lights with one visibility term: what is kept from pass to pass and from frame to frame.

#include "gi/methods/vpl/gather.h"
#include "gi/render/accumulator.h"
#include "gi/render/frame_renderer.h"

#include <tbb/combinable.h>

namespace gi {

class VirtualLightRenderer {
public:
    /// `world`, `settings` and `report` outlive this; the arrays of the world stay where they are.
    VirtualLightRenderer(VisibilityKind kind, World const& world, RenderSettings const& settings,
                         std::size_t first_moving, Report& report);

    /// See Changes.
    void changed(Changes const& changes);
    /// One more path for every pixel of all views, lit by the virtual lights of that pass.
    /// @param sums  one per view
    void pass(std::uint32_t index, std::span<FrameView const> views, std::span<Accumulator> sums);
    /// What has been done since the last call.
    void report_work();
    double rays() const { return rays_; } ///< closest-hit and shadow rays, so far

private:
    struct Counts {
        PathCounts paths;
        GatherCounts gather;
    };
    void build();
    void trace_view(FrameView const& view, std::uint32_t index, std::span<VirtualLight const> lights,
                    Accumulator& sums);

    VisibilityKind kind_;
    World const& world_;
    RenderSettings const& settings_;
    std::size_t first_moving_;
    Report& report_;
    std::unique_ptr<ExactVisibility> visibility_;
    std::unique_ptr<VisibilityTerm> term_;
    GatherCounts gathered_;
    std::uint64_t lights_ = 0;
    double rays_ = 0;
};

} // namespace gi
