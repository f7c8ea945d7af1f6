#pragma once
// Everything that the method slhb keeps from pass to pass and, where things move, from frame to frame: the
// structures built from the world, and what of them a pass needs anew.

#include "gi/methods/slhb/directions/frame_axes.h"
#include "gi/methods/slhb/hit_buffer/motion.h"
#include "gi/methods/slhb/tracer/view_paths.h"

#include <memory>
#include <optional>

namespace gi {

/// How first surfaces are found.
enum class FirstSurfaces : std::uint8_t {
    by_raster, ///< a G-buffer for each pass; motion vectors and partner views are of that
    by_rays,   ///< each path through a point of its own of its pixel
};

class SlhbRenderer {
public:
    /// Builds what lasts; throws Interrupted where `stop` asks for it meanwhile. `world` and `report` outlive
    /// this; the arrays of the world stay where they are.
    /// @param views  at least one  @param settings  with those of slhb chosen  @param soup  of the world
    SlhbRenderer(World const& world, std::span<FrameView const> views, RenderSettings const& settings,
                 TriangleSoup soup, std::size_t first_moving, Report& report,
                 FirstSurfaces first_surfaces = FirstSurfaces::by_raster, StopRequest const* stop = nullptr);

    /// A frame ends here: motion vectors lead to what is seen now.
    void end_frame();
    /// The world has changed, but nothing of what lets rays through. What does not depend on that stays.
    void changed(Changes const& changes);
    /// From the next frame on: of the stored axes of each bounce about `axes` follow what moves, others from frame
    /// to frame, and paths take no others; 0 = all.
    void update_axes(std::uint32_t axes) { axes_.update_axes(axes); }
    /// In the frame that ended last.
    DynamicUpdate dynamic_update() const { return axes_.dynamic_update(); }
    /// From the next pass on. A view is what the view of the same index was in the frame before.
    void see(std::span<FrameView const> views);
    /// One more path for every pixel. @param index of the pass, which decides its random numbers
    /// @param sums  one per view
    void pass(std::uint32_t index, std::span<Accumulator> sums, VertexSharing sharing = VertexSharing::exact);

    /// A pass of one view with what moves and without it, by the same random numbers: of the latter only the paths
    /// that what moves may count in. Not with orthographic cameras, nor where something is asked exactly.
    void pair_pass(std::uint32_t index, PairSums& sums, PathCounts& counts);

    /// Motion vectors of the last pass, to the frame that ended before it; not with orthographic cameras.
    void add_motion(std::size_t view, Picture& picture) const;
    /// For every pixel whose path of the last pass met a triangle that can move first: adds 1, and what it
    /// brought.
    /// @param counts, radiance  one per pixel. Not with orthographic cameras, where nothing is added.
    void add_coverage(std::size_t view, std::span<float> counts, std::span<vec3> radiance) const;
    /// RenderResult::light_from of the passes since the sums were empty.
    std::span<std::uint32_t const> light_from(std::size_t view) const;
    /// From the next pass on: indirect light in one of n x n pixels, which others take from there where paths send
    /// exact rays; where they share vertices on layers, it counts n^2-fold.
    void interleave(int n)
    {
        settings_.slhb.interleave = n;
        spread_ = n > 1;
    }
    double indirect_share() const { return paths_.indirect_share(); } ///< of the time of the last pass' paths
    double rays() const { return paths_.rays(); }                     ///< look-ups and exact rays, so far
    /// Beyond the limit of a texel, so far.
    std::uint64_t lost_layers() const { return axes_.lost(); }
    /// Notes that the radiance cache had no room for, so far.
    std::uint64_t refused_notes() const { return cache_ ? cache_->refused() : 0; }
    /// What follows owes nothing to what was rendered before.
    void forget()
    {
        if (cache_) cache_->clear();
    }
    /// What has been done so far.
    void report_work() const;

private:
    /// Its triangles from the first that moves on, or its lights.
    void world_moved(bool geometry, bool lights);
    /// Colours, roughnesses or the sky.
    void materials_changed();
    bool orthographic() const;
    void build_exact();
    void make_axes();
    void make_lamps();
    bool walks() const;
    bool to_the_end() const;
    enum class Sides : std::uint8_t { one, pair };
    void prepare(std::uint32_t index, Sides sides);
    SlhbTracer::Pass tracing(std::uint32_t index, bool cached);

    World const& world_;
    RenderSettings settings_;
    SlhbSettings const& slhb_ = settings_.slhb;
    std::size_t first_moving_; ///< triangle
    FirstSurfaces first_surfaces_;
    StopRequest const* stop_; ///< of building; may be null
    Report& report_;
    SeenViews views_;
    TriangleSoup soup_;
    CutOuts cut_outs_;
    std::unique_ptr<ExactVisibility> exact_;
    Bounds grid_bounds_; ///< of the hit buffers
    FrameAxes axes_;
    LightOrder light_order_;
    LightPool lights_;        ///< of a pass; empty where there are shadow maps
    bool shadow_maps_ = true; ///< else paths send shadow rays of their own
    std::optional<LightPoints> light_points_;
    EarlierCorners earlier_;
    std::vector<SkyAlong> sky_;          ///< in a pass
    std::optional<RadianceCache> cache_; ///< none where it was declined
    ViewPaths paths_;
    bool spread_ = false;            ///< see Pass::spread
    std::uint64_t earlier_maps_ = 0; ///< of lamps that are no more
};

} // namespace gi
