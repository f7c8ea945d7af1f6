#pragma once
// Where the pictures of one place of the screen come from: rendered while they are seen, or ahead.

#include "viewer/displays/stereo_mode.h"
#include "viewer/engine/live/live_renderer.h"
#include "viewer/engine/live/navigation.h"
#include "viewer/experiment/stimulus_settings.h"

namespace viewer {

/// What a stimulus needs to know of where it is shown.
struct StimulusView {
    glm::ivec2 size_px{}; ///< of its place on the screen
    StereoMode stereo = StereoMode::off;
    double duration_s = 6; ///< of one round of a path
    int warmup_frames = 0;
    /// On walls: the views of all eyes from a camera, in place of size and stereo.
    std::function<std::vector<ViewCommand>(gi::Camera const&)> on_walls;
};

/// How scenes are read, and which camera of one is meant by a name (empty = its first). Both throw InputError.
struct SceneAccess {
    LoadScene load;
    std::function<gi::Camera(gi::World const&, std::string const& name)> camera;
};

class StimulusSource {
public:
    virtual ~StimulusSource() = default;
    /// Begins to make the first picture ready, in the background. What was shown before is forgotten.
    virtual void prepare(StimulusSettings const& stimulus, StimulusView const& view) = 0;
    /// The first picture can be shown without delay. Throws InputError where it never will be.
    virtual bool is_ready() = 0;
    /// It is seen since so long, s: the camera moves on. Negative = not yet, nothing moves.
    virtual void at(double seconds) = 0;
    /// Other settings of the same scene, seen as soon as they are rendered.
    virtual void change(StimulusSettings const& stimulus) = 0;
    /// Somebody goes about in it, from the stimulus's camera on. @param seconds  since the last call
    virtual void walk(NavigationInput const& input, double seconds) = 0;
    /// Rests until the next prepare(): takes no processor time from others. What newest() gave stays.
    virtual void rest() = 0;
    /// Shown again it would go on where it was: it has to be prepared again to begin anew.
    virtual bool moves() const = 0;
    virtual std::shared_ptr<LiveFrame const> newest() = 0;
};

} // namespace viewer
