#pragma once
// Everything that paths on the CPU keep between passes and, in sequences, between frames: the structures built from
// the world, and their per-pass updates.

#include "gi/hit_buffers/directions/frame_axes.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/methods/paths/view_paths.h"

#include <memory>
#include <optional>

namespace gi {

class PathsRenderer {
public:
    /// Builds the lasting structures; throws Interrupted if `stop` is requested meanwhile. `world` and `report`
    /// must outlive this object, and the world's arrays must not be reallocated.
    /// @param views  at least one  @param settings  chosen ones  @param soup  of the world
    PathsRenderer(World const& world, std::span<FrameView const> views, RenderSettings const& settings,
                 TriangleSoup soup, std::size_t first_moving, Report& report,
                 FirstSurfaces first_surfaces = FirstSurfaces::by_raster, StopRequest const* stop = nullptr);

    /// Ends a frame: the next motion vectors refer to its state.
    void end_frame();
    /// Updates the structures that depend on the changes. Coverage (transparency) must not have changed.
    void changed(Changes const& changes);
    /// From the next frame on: update about `axes` stored axes per bounce each frame, round-robin; paths sample
    /// only the updated ones; 0 = all.
    void update_axes(std::uint32_t axes) { axes_.update_axes(axes); }
    /// Counts of the last completed frame.
    DynamicUpdate dynamic_update() const { return axes_.dynamic_update(); }
    /// Sets the views from the next pass on. Each continues the previous frame's view of the same index.
    void see(std::span<FrameView const> views);
    /// What `see` and passes without look-ups change, for a frame that is undone.
    struct Before {
        std::vector<TracedView> views;
        std::uint32_t cache_passes = 0;
        std::optional<RadianceCache> cache; ///< if the frame teaches it
    };
    /// @return nothing if the cache is too large to be copied
    std::optional<Before> before(bool teaches) const;
    void go_back(Before&& before);
    /// Traces one more path for every pixel. @param index  of the pass; selects the random numbers
    /// @param sums  one per view; unchanged if `stop` makes this throw Interrupted. Then there can be no further
    ///   pass, unless go_back() is called
    void pass(std::uint32_t index, std::span<Accumulator> sums, VertexSharing sharing, PassStop stop);

    /// Traces a pass of one view with and without dynamic geometry, with the same random numbers; without it,
    /// only paths that dynamic geometry may affect are traced. Not for orthographic cameras, nor with ExactParts.
    void pair_pass(std::uint32_t index, PairSums& sums, PathCounts& counts);

    /// Adds the motion vectors of the last pass, relative to the previous frame; not for orthographic cameras.
    void add_motion(std::size_t view, Picture& picture) const;
    /// For every pixel whose path in the last pass first hit a dynamic triangle: adds 1 to counts, and the path's
    /// radiance to radiance.
    /// @param counts, radiance  one per pixel. Adds nothing for orthographic cameras.
    void add_coverage(std::size_t view, std::span<float> counts, std::span<vec3> radiance) const;
    /// RenderResult::light_from over the passes since the sums were empty.
    std::span<std::uint32_t const> light_from(std::size_t view) const;
    /// From the next pass on: compute indirect light for one pixel in each n x n block. With exact rays, the
    /// other pixels take it from there; if paths share vertices on layers, it is weighted by n^2 instead.
    void interleave(int n)
    {
        settings_.of<PathsSettings>().interleave = n;
        spread_ = n > 1;
    }
    /// From the next pass on, see FrameRenderer::leave_out_punctual.
    void leave_out_punctual(bool on) { leaves_out_punctual_ = on; }
    /// From the next pass on, if there are any. Photons are those of a pass's index.
    void find_lamp_caustics()
    {
        if (exact_ && LampCaustics::exist(world_, settings_)) caustics_.emplace(world_, settings_, report_);
    }
    /// From the next pass on, if exact rays decide what is doubtful: some paths of the first view are traced again, by look-ups
    /// and by exact rays.
    void control_bias()
    {
        if (slhb_.confirm == Confirming::on && exact_) control_.emplace();
    }
    std::optional<LookUpBias> look_up_bias() const { return control_ ? control_->bias() : std::nullopt; }
    /// Fraction of the last pass's path time that went into indirect light.
    double indirect_share() const { return paths_.indirect_share(); }
    TriangleSoup const& soup() const { return traced_.soup; }
    /// Number of look-ups and exact rays so far.
    double rays() const { return paths_.rays(); }
    /// See Windows::option().
    std::string level_option() const { return traced_.windows.option(); }
    /// Number of layers beyond a texel's limit, so far.
    std::uint64_t lost_layers() const { return axes_.lost(); }
    /// Number of notes for which the radiance cache had no room, so far.
    std::uint64_t refused_notes() const { return cache_ ? cache_->refused() : 0; }
    /// Makes later passes independent of earlier ones (clears the radiance cache).
    void forget()
    {
        if (cache_) cache_->clear();
    }
    /// Reports the work done so far.
    void report_work() const;

private:
    /// Updates the dynamic triangles, the lights, or both.
    void world_moved(bool geometry, bool lights);
    /// Updates colours, roughnesses and the sky.
    void materials_changed();
    bool orthographic() const;
    /// True if all views are gathered from layers: each has a lens, or moves while the shutter is open.
    bool gathers() const;
    void build_exact();
    void make_axes();
    void make_light_points();
    bool walks() const;
    enum class Sides : std::uint8_t { one, pair };
    void prepare(std::uint32_t index, Sides sides, PassStop const& stop);
    PathsTracer::Pass tracing(std::uint32_t index, bool cached, PassStop& stop);
    void fit_primary(SeenView& view, bool has_same_size);

    World const& world_;
    RenderSettings settings_;
    SlhbSettings const& slhb_ = settings_.of<SlhbSettings>();
    PathsSettings const& own_ = settings_.of<PathsSettings>();
    PathAlgorithm const by_ = settings_.of<PathAlgorithm>();
    FirstSurfaces first_surfaces_;
    StopRequest const* stop_; ///< of building; may be null
    Report& report_;
    SeenViews views_;
    TracedWorld traced_;
    std::unique_ptr<ExactVisibility> exact_;
    FrameAxes axes_;
    LightOrder light_order_;
    LightPool lights_;        ///< of a pass; empty with shadow maps
    bool shadow_maps_ = true; ///< else paths trace their own shadow rays
    std::optional<LightPoints> light_points_;
    std::vector<SkyAlong> sky_;          ///< in a pass
    std::optional<RadianceCache> cache_; ///< none if switched off
    std::optional<LampCaustics> caustics_;
    std::optional<BiasControl> control_;
    ViewPaths paths_;
    bool spread_ = false; ///< see Pass::spread
    bool leaves_out_punctual_ = false;
    std::uint64_t earlier_maps_ = 0; ///< built for earlier light points that no longer exist
};

} // namespace gi
