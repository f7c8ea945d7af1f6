#pragma once
// Everything that the method slhb keeps from pass to pass and, where things move, from frame to frame: the
// structures built from the world, and how a pass goes through them.

#include "gi/slhb/motion.h"
#include "gi/slhb/primary_map.h"
#include "gi/slhb/shared_endings.h"
#include "gi/slhb/tracer.h"
#include "gi/transport/accumulator.h"

#include <memory>
#include <optional>

namespace gi {

class SlhbRenderer {
public:
    /// Builds what lasts. `world` and `report` outlive this; the arrays of the world stay where they are.
    /// @param settings  with those of slhb chosen  @param soup  of the world
    SlhbRenderer(World const& world, Camera const& camera, RenderSettings const& settings, TriangleSoup soup,
                 std::size_t first_moving, Report& report);

    /// A frame ends here: motion vectors lead to what is seen now.
    void end_frame();
    /// The world has changed: its triangles from the first that moves on, or its lights. What does not depend on
    /// that stays.
    void world_moved(bool geometry, bool lights);
    void set_camera(Camera const& camera);
    /// One more path for every pixel. @param index of the pass, which decides its random numbers
    void pass(std::uint32_t index, Accumulator& sums);

    /// Motion vectors of the last pass, to the frame that ended before it; not with orthographic cameras.
    void add_motion(Picture& picture) const;
    double rays() const; ///< look-ups and exact rays, so far
    /// Beyond the limit of a texel, so far.
    std::uint64_t lost_layers() const { return earlier_sets_.lost + axes_->lost(); }
    /// What has been done so far.
    void report_work() const;

private:
    void build_exact();
    void make_axes();
    void make_lamps();
    bool to_the_end() const;
    void trace(std::uint32_t index, Accumulator& sums);

    World const& world_;
    RenderSettings settings_;
    SlhbSettings const& slhb_ = settings_.slhb;
    std::size_t first_moving_; ///< triangle
    Report& report_;
    bool orthographic_;
    bool walks_;      ///< paths may leave a surface along an axis
    CameraRays rays_; ///< through the middle of the lens, where motion vectors are measured
    TriangleSoup soup_;
    CutOuts cut_outs_;
    std::unique_ptr<ExactVisibility> exact_, judge_;
    Bounds grid_bounds_; ///< of the hit buffers
    std::optional<AxisSet> axes_;
    std::optional<Lamps> lamps_;
    std::optional<PrimaryMap> primary_; ///< not of orthographic cameras
    EarlierFrame earlier_;
    SharedEndings shared_;
    std::vector<PathSample> samples_;
    std::vector<Ending> endings_;
    SlhbCounts done_;
    /// Of sets of axes and lamps that are no more.
    struct {
        std::uint64_t axes = 0, layers = 0, lost = 0, maps = 0;
    } earlier_sets_;
};

} // namespace gi
