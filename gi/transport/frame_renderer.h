#pragma once
// Frames of a world that moves, one after another. What did not change since the frame before is kept.

#include "gi/image/render_settings.h"
#include "gi/scene/moving_world.h"

namespace gi {

class FrameRenderer {
public:
    virtual ~FrameRenderer() = default;

    /// The world has changed; before the next frame.
    virtual void changed(Changes const& changes) = 0;
    /// Renders what the camera sees now, with the budget and paths of the settings for every frame. Layers as
    /// those of RenderResult and, where the method knows it, "motion" (see gi/slhb/motion.h).
    virtual RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress) = 0;
};

/// Starts with the world as it is; it and the report outlive the renderer.
using StartFrames = std::unique_ptr<FrameRenderer> (*)(MovingWorld const&, Camera const&, RenderSettings const&,
                                                       Report&);

} // namespace gi
