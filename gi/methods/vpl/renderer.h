#pragma once
// Renders pictures with virtual lights and one visibility term; keeps structures between passes and frames.

#include "gi/methods/vpl/gather.h"
#include "gi/render/pass_renderer.h"

#include <tbb/combinable.h>

namespace gi {

class VirtualLightRenderer : public PassRenderer {
public:
    /// `world`, `settings` and `report` must outlive this object, and the world's arrays must not be reallocated.
    /// @param stop  of building, which throws Interrupted; null = never
    VirtualLightRenderer(VisibilityKind kind, World const& world, RenderSettings const& settings,
                         std::size_t first_moving, Report& report, StopRequest const* stop = nullptr);

    void changed(Changes const& changes) override;
    /// All views are lit by the virtual lights of this pass.
    void pass(std::uint32_t index, std::span<FrameView const> views, std::span<Accumulator> sums,
              MotionVectors* motion, StopRequest const* stop) override;
    void report_work() override;
    double rays() const override { return rays_; }
    std::string options() const override;

private:
    struct Counts {
        PathCounts paths;
        GatherCounts gather;
    };
    void build(StopRequest const* stop);
    void trace_view(FrameView const& view, std::uint32_t index, std::span<LightVertex const> lights,
                    Accumulator& sums, std::span<FirstHit> first_hits, StopRequest const* stop);

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
