#pragma once
// One light-transport method at work on the frames of a session, with the light that it reuses.

#include "gi/filter/temporal.h"
#include "gi/methods/registry.h"
#include "viewer/engine/hidden_views.h"
#include "viewer/engine/settings.h"

#include <memory>

namespace viewer {

/// What has happened between two frames, as temporal reuse sees it.
gi::SceneChange scene_change(gi::Changes const& changes, bool camera_moved);

class MethodRunner {
public:
    /// The world and the report outlive it. @param first  views whose size the plan counts with
    MethodRunner(std::string const& method, gi::MovingWorld const& world, Settings const& settings, int threads,
                 std::vector<ViewCommand> const& first, gi::Report& report);

    /// A picture per view. @param hidden  per view  @param changes  of the world since the last frame
    std::vector<gi::RenderResult> render(FrameCommand const& order, std::span<HiddenPixels const> hidden,
                                         gi::Changes const& changes, Settings const& settings,
                                         gi::StopRequest const& stop);
    int still_frames() const { return still_; }
    gi::DynamicUpdate dynamic_update() const { return renderer_->dynamic_update(); } ///< of the last frame

private:
    struct Seen { ///< of a view
        std::string name;
        gi::Camera camera;
        int width = 0, height = 0;
        std::unique_ptr<gi::TemporalReuse> reuse;
        int most_frames = 0;
        HiddenPixels hidden;
    };
    /// Reuse and filter of a view. @param partner  whose light it may have taken; finished before
    void finish(std::size_t view, std::vector<gi::RenderResult>& results, int partner, gi::SceneChange change,
                Settings const& settings);

    gi::Report& report_;
    int threads_;
    std::unique_ptr<gi::FrameRenderer> renderer_;
    std::vector<Seen> seen_;
    bool first_ = true;
    int still_ = 0; ///< frames since something moved, changed or was looked at from elsewhere
};

} // namespace viewer
