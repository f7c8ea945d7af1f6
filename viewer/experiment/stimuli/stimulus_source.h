#pragma once
// Source of the pictures for one place on the screen: rendered while they are shown, or ahead.

#include "viewer/displays/stereo_mode.h"
#include "viewer/engine/live/live_renderer.h"
#include "viewer/engine/live/navigation.h"
#include "viewer/experiment/stimuli/stimulus_settings.h"

namespace viewer {

/// Where and how a stimulus is shown.
struct StimulusView {
    glm::ivec2 size_px{}; ///< of its place on the screen
    StereoMode stereo = StereoMode::off;
    double duration_s = 6; ///< of one round of the path
    int warmup_frames = 0;
    /// On walls: returns the views of all eyes for a camera; replaces size and stereo.
    std::function<std::vector<ViewCommand>(gi::Camera const&)> on_walls;
};

/// Functions that load a scene and find a camera in it by name (empty = its first). Both throw InputError.
struct SceneAccess {
    LoadScene load;
    std::function<gi::Camera(gi::World const&, std::string const& name)> camera;
};

class StimulusSource {
public:
    virtual ~StimulusSource() = default;
    /// Starts preparing the first picture in the background. Discards the previous stimulus.
    virtual void prepare(StimulusSettings const& stimulus, StimulusView const& view) = 0;
    /// True if the first picture can be shown without delay. Throws InputError if preparation failed.
    virtual bool is_ready() = 0;
    /// Sets the time since the onset, s, which moves the camera. Negative = not shown yet, nothing moves.
    virtual void at(double seconds) = 0;
    /// Changes settings of the same scene; shown as soon as they are rendered.
    virtual void change(StimulusSettings const& stimulus) = 0;
    /// Free walk in the scene, starting at the stimulus's camera. @param seconds  since the last call
    virtual void walk(NavigationInput const& input, double seconds) = 0;
    /// Rests until the next prepare(), without using processor time. The picture from newest() stays valid.
    virtual void rest() = 0;
    /// True if the stimulus moves: shown again, it would continue, so it must be prepared again to restart.
    virtual bool moves() const = 0;
    virtual std::shared_ptr<LiveFrame const> newest() = 0;
    /// The newest poses, for which the surfaces of a frame are drawn; none = the frame is shown as it was rendered.
    virtual std::optional<FrameCommand> moment(LiveFrame const&) { return {}; }
    /// How large the screen draws surfaces, as Viewpoint::drawn_scale.
    virtual void drawn_at(double /*scale*/) {}
};

} // namespace viewer
