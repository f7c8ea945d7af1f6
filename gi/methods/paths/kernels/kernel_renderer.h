#pragma once
// Counterpart of PathsRenderer that runs the passes of paths or slhb as kernels in one space,
// and keeps structures between passes and frames. Light samples, axes and random numbers are the same,
// so that both trace the same paths up to rounding.
//
// Of slhb: hit buffers are built from all triangles: after motion, the buffers used by paths and all shadow maps are
// rebuilt (dynamic geometry is not added to static buffers as on the CPU). The BVH for exact rays, built if some
// lobe is narrow or doubts are decided by rays, has a tree of dynamic triangles, which is refitted. Views do not reuse each other's light,
// and paths do not share vertices. For the limits of paths see path_kernel.h.

#include "gi/hit_buffers/directions/frame_axes.h"
#include "gi/methods/paths/algorithm.h"
#include "gi/methods/paths/kernels/kernel_scene.h"
#include "gi/methods/paths/light_pool.h"
#include "gi/methods/paths/traced_world.h"
#include "gi/render/accumulator.h"
#include "gi/render/frame_renderer.h"
#include "gi/render/sums_on.h"

#include <optional>

namespace gi {

template <Space S>
class KernelRenderer {
public:
    /// Throws InputError on features that kernels lack: an orthographic camera, --cone, --gather, --packed,
    /// --interleave; those of slhb, --radiance-cache on.
    static void check(Camera const& camera, RenderSettings const& settings);
    /// Sets what the plan would choose for the CPU to what kernels have.
    static void limit(RenderSettings& chosen) { chosen.of<PathsSettings>().interleave = 1; } // regardless of the budget

    /// See PathsRenderer.
    KernelRenderer(World const& world, std::span<FrameView const> views, RenderSettings const& settings,
                   TriangleSoup soup, std::size_t first_moving, Report& report,
                   FirstSurfaces first_surfaces = FirstSurfaces::by_raster);

    void end_frame();
    void changed(Changes const& changes);
    void update_axes(std::uint32_t axes) { axes_.update_axes(axes); }
    DynamicUpdate dynamic_update() const { return axes_.dynamic_update(); }
    /// Throws InputError on orthographic cameras.
    void see(std::span<FrameView const> views);
    /// Paths do not share vertices, and end in cells if the method is paths.
    void pass(std::uint32_t index, std::span<Accumulator> sums, VertexSharing sharing = VertexSharing::none)
    {
        passes(index, 1, sums, sharing, nullptr);
    }
    /// Several passes, while the sums stay in the space. @param stop  ends them after a pass; null = never
    void passes(std::uint32_t index, std::uint32_t count, std::span<Accumulator> sums, VertexSharing sharing,
                StopRequest const* stop);
    /// See PathsRenderer.
    void forget()
    {
        if (scene_.cache() != nullptr) scene_.cache()->clear();
    }
    std::uint64_t refused_notes() { return scene_.cache() != nullptr ? scene_.cache()->refused() : 0; }
    void add_motion(std::size_t view, Picture& picture) const;
    /// Empty: no light is reused from a partner.
    std::span<std::uint32_t const> light_from(std::size_t) const { return {}; }
    double rays() const
    {
        return double(queries_ + exact_rays_ + shadow_lookups_ + doubtful_shadows_ + shadow_rays_);
    }
    /// See Windows::option().
    std::string level_option() const { return traced_.windows.option(); }
    std::uint64_t lost_layers() const { return axes_.lost(); }
    void report_work();
    KernelScene<S>& scene() { return scene_; }

private:
    struct View : TracedView {
        std::vector<std::uint8_t> hides; ///< the pixels that `hidden` was made from
        Buffer<std::uint8_t, S> hidden;  ///< as in FrameView
        CameraRays eye{};                ///< of the last pass
        std::uint32_t index = 0;
        Buffer<NearestTexel, S> primary; ///< of the last pass
        SumsOn<S> sums;
    };

    bool free() const { return settings_.of<PathAlgorithm>().surfaces == SurfacesBy::rays; }
    bool walks() const { return !free() && (settings_.bounces > 0 || meets_light(world_)); }
    std::size_t pixels() const
    {
        std::size_t sum = 0;
        for (View const& v : views_) sum += v.pixels();
        return sum;
    }
    void build_exact();
    void make_axes();
    void make_light_points();
    void prepare(std::uint32_t index);
    void add_pass(std::uint32_t index, std::span<Accumulator> sums, bool cached);

    World const& world_;
    RenderSettings settings_;
    SlhbSettings const& slhb_ = settings_.of<SlhbSettings>();
    Report& report_;
    std::vector<View> views_;
    TracedWorld traced_;
    KernelScene<S> scene_;
    FrameAxes axes_;
    std::optional<LightPoints> light_points_;
    FirstSurfaces first_surfaces_;
    LightOrder light_order_; ///< of paths, like the following
    LightPool lights_;
    std::uint64_t queries_ = 0, exact_rays_ = 0, shadow_lookups_ = 0, shadow_rays_ = 0, cache_reads_ = 0,
                  doubtful_queries_ = 0, doubtful_shadows_ = 0;
    /// Pixels not traced because they are hidden; all pixels; over all passes.
    std::uint64_t hidden_ = 0, pixels_ = 0;
    std::uint64_t earlier_maps_ = 0;        ///< built for earlier light points that no longer exist
};

} // namespace gi
