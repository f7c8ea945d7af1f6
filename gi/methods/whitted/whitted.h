#pragma once
// The method whitted: ray tracing with mirrors, glass and shadows (see tree_tracer.h),
// without diffuse interreflection.

#include "gi/methods/whitted/tree_tracer.h"
#include "gi/render/pass_renderer.h"
#include "gi/render/render_option.h"

#include <memory>
#include <optional>

namespace gi {

/// Passes of ray trees; keeps the BVH between them. Base of the methods that add indirect light.
class TreeRenderer : public PassRenderer {
public:
    /// See StartPasses.
    TreeRenderer(World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                 StopRequest const* stop);

    void changed(Changes const& changes) override;
    void begin(std::uint32_t index, std::span<FrameView const> views, StopRequest const* stop) override;
    void pass(std::uint32_t index, std::span<FrameView const> views, std::span<Accumulator> sums,
              MotionVectors* motion, StopRequest const* stop) override;
    void report_work() override;
    double rays() const override { return rays_; }
    std::string options() const override;

protected:
    /// Called before the trees of a pass. Returns their indirect light, or null.
    virtual SurfaceLight const* prepare(std::uint32_t, std::span<FrameView const>, StopRequest const*)
    {
        return nullptr;
    }
    /// True if photons bring the light of lamps that goes through panes; else shadow rays do.
    virtual bool photons_pass_panes() const { return false; }

    World const& world_;
    RenderSettings const& settings_;
    std::size_t first_moving_;
    Report& report_;
    std::unique_ptr<ExactVisibility> visibility_;
    double rays_ = 0;
    TreeCounts work_; ///< since the last report

private:
    void build(StopRequest const* stop);
    void trace_view(FrameView const& view, std::uint32_t index, SurfaceLight const* light, Accumulator& sums,
                    std::span<FirstHit> first_hits, StopRequest const* stop);

    /// What begin() has prepared: the light of the pass of this index.
    std::optional<std::uint32_t> prepared_;
    SurfaceLight const* light_of_prepared_ = nullptr;
    double trees_ = 0; ///< since the last report
};

/// --recursion, --cutoff, --shadow-rays.
RenderOptionTable const& whitted_options();

RenderResult render_whitted(World const& world, Camera const& camera, RenderSettings const& settings,
                            StopRequest const& stop, RenderProgress const& progress, Report& report);
/// See StartFrames.
std::unique_ptr<FrameRenderer> start_whitted_frames(MovingWorld const& world, Camera const& camera,
                                                    RenderSettings const& settings, Report& report);

} // namespace gi
