#pragma once
#include "gi/filter/temporal.h"
#include "gi/methods/registry.h"
#include "gi/scene/motion/moving_world.h"
#include "viewer/engine/flat_triangles.h"
#include "viewer/engine/method_runner.h"

namespace viewer {

/// Renders consecutive frames: advances the world in place, keeps structures of static geometry, and reuses the
/// light of earlier frames.
class FrameFollower {
public:
    struct Frame {
        gi::RenderResult result;
        gi::TemporalCounts counts;
        std::vector<std::string> changes; ///< since the previous frame, with reasons
    };

    /// @param origin  origin of the world, as in build_world
    FrameFollower(std::shared_ptr<gi::Scene const> scene, double time_s, gi::Method const& method,
                  gi::RenderSettings const& settings, int most_frames,
                  std::optional<gi::dvec3> origin = std::nullopt);

    gi::World const& go_to(double time_s);
    /// @param report  receives the times and losses of this frame; the first frame includes those of the world
    Frame render(gi::Camera const& camera, gi::StopRequest const& stop, gi::RenderProgress const& progress,
                 gi::Report& report);

private:
    gi::Method const& method_;
    gi::RenderSettings settings_;
    gi::Report report_; ///< for all frames
    gi::ReportReader added_{report_};
    gi::MovingWorld world_;
    FlatTriangles flat_;
    gi::Changes changes_;
    std::unique_ptr<gi::FrameRenderer> renderer_;
    std::optional<gi::MethodChoice> choice_; ///< of a method that chooses another
    gi::TemporalReuse reuse_;
    gi::Camera last_camera_;
};

} // namespace viewer
