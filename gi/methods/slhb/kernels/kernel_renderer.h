#pragma once
// Passes of the method slhb by kernels in one space, from pass to pass and, where things move, from frame to
// frame: SlhbRenderer's counterpart. Points on lamps, axes and random numbers are the same, so that both trace the
// same paths but for rounding.
//
// Hit buffers are built of all that there is: where something has moved, those that paths take are built anew
// (what moves is not appended to what stays, as on the CPU), and so are all shadow maps. Views take no light from
// each other, and paths share no vertices. What paths lack is in path_kernel.h.

#include "gi/methods/slhb/directions/frame_axes.h"
#include "gi/methods/slhb/hit_buffer/motion.h"
#include "gi/methods/slhb/kernels/kernel_scene.h"
#include "gi/render/accumulator.h"
#include "gi/render/frame_renderer.h"

#include <optional>

namespace gi {

/// Throws InputError on what kernels cannot do: an orthographic camera, --cone, --gather, --packed, --interleave.
void check_kernels_can(Camera const& camera, SlhbSettings const& settings);

template <Space S>
class KernelRenderer {
public:
    /// See SlhbRenderer.
    KernelRenderer(World const& world, std::span<FrameView const> views, RenderSettings const& settings,
                   TriangleSoup soup, std::size_t first_moving, Report& report);

    void end_frame();
    void changed(Changes const& changes);
    void update_axes(std::uint32_t axes) { axes_.update_axes(axes); }
    DynamicUpdate dynamic_update() const { return axes_.dynamic_update(); }
    /// Throws InputError on orthographic cameras.
    void see(std::span<FrameView const> views);
    /// @param endings  of no account: each path finds its own
    void pass(std::uint32_t index, std::span<Accumulator> sums, VertexSharing sharing = VertexSharing::none);
    void add_motion(std::size_t view, Picture& picture) const;
    /// None is taken from a partner.
    std::span<std::uint32_t const> light_from(std::size_t) const { return {}; }
    double rays() const { return double(queries_ + shadow_lookups_); }
    std::uint64_t lost_layers() const { return axes_.lost(); }
    void report_work() const;

private:
    struct View {
        CameraRays rays, earlier; ///< through the middle of the lens
        int width = 0, height = 0;
        std::vector<std::uint8_t> hides; ///< what `hidden` was made of
        Buffer<std::uint8_t, S> hidden;  ///< as FrameView has it
        std::size_t hidden_pixels = 0;
        CameraRays eye{}; ///< of the last pass
        std::uint32_t index = 0;
        Buffer<NearestTexel, S> primary; ///< the same
        std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    };

    bool meets_light() const;
    bool walks() const { return settings_.bounces > 0 || meets_light(); }
    void make_axes();
    void make_lamps();
    void prepare(std::uint32_t index);

    World const& world_;
    RenderSettings settings_;
    SlhbSettings const& slhb_ = settings_.slhb;
    std::size_t first_moving_; ///< triangle
    Report& report_;
    std::vector<View> views_;
    TriangleSoup soup_;
    CutOuts cut_outs_;
    KernelScene<S> scene_;
    Bounds grid_bounds_; ///< of the hit buffers
    FrameAxes axes_;
    std::optional<LightPoints> light_points_;
    EarlierCorners earlier_;
    std::uint64_t queries_ = 0, shadow_lookups_ = 0;
    std::uint64_t hidden_ = 0, pixels_ = 0; ///< not traced, as nobody sees them; all, in all passes
    std::uint64_t earlier_maps_ = 0;        ///< of lamps that are no more
};

} // namespace gi
