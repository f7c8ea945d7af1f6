#pragma once
#include "gi/filter/temporal.h"
#include "gi/methods/registry.h"
#include "gi/scene/motion/moving_world.h"
#include "viewer/engine/flat_triangles.h"
#include "viewer/engine/method_runner.h"

namespace viewer {

/// Frames that follow each other: the world is moved on in place, structures of what stays are kept, and the light
/// of earlier frames is reused.
class FrameFollower {
public:
    struct Frame {
        gi::RenderResult result;
        gi::TemporalCounts counts;
        std::vector<std::string> changes; ///< since the frame before, with reasons
    };

    /// @param origin  of the world, as in build_world
    /// Throws InputError where the method does not give what reuse needs.
    FrameFollower(std::shared_ptr<gi::Scene const> scene, double time_s, gi::Method const& method,
                  gi::RenderSettings const& settings, int most_frames,
                  std::optional<gi::dvec3> origin = std::nullopt);

    gi::World const& go_to(double time_s);
    /// @param report  gets the times and losses of this frame, the first one also those of the world
    Frame render(gi::Camera const& camera, gi::StopRequest const& stop, gi::RenderProgress const& progress,
                 gi::Report& report);

private:
    gi::Method const& method_;
    gi::RenderSettings settings_;
    gi::Report report_; ///< of all frames
    gi::ReportReader added_{report_};
    gi::MovingWorld world_;
    FlatTriangles flat_;
    gi::Changes changes_;
    std::unique_ptr<gi::FrameRenderer> renderer_;
    gi::TemporalReuse reuse_;
    gi::Camera last_camera_;
};

} // namespace viewer
