#pragma once
// Sequences of frames rendered on demand: a viewer::RenderSession with its views,
// and the settings of an experiment's stimulus.

#include "viewer/engine/governor.h"
#include "viewer/engine/render_session.h"
#include "viewer/experiment/stimuli/stimulus_place.h"

#include <mutex>

namespace bindings {

/// Paths per pixel of a frame: a fixed number, or as many as the governor expects to fit into the budget.
struct FrameWork {
    std::optional<int> paths;
    double budget_s = 0.05;
};

struct MadeFrame {
    viewer::SessionFrame frame;
    double seconds = 0;
    double exposure_ev = 0; ///< setting of the frame, as `tone`
    std::string tone;
};

class Frames {
public:
    /// @param threads  0 = all
    explicit Frames(int threads);

    /// Throws InputError; nothing has changed then.
    void set(viewer::Change const& change);
    nlohmann::json get(std::string const& key) const;
    gi::Report const& report() const { return report_; }
    /// Camera of the scene; empty = its first, or one that frames the scene. Throws InputError.
    gi::Camera camera(std::string const& name) const;

    /// Applies scene, settings and edits of a stimulus and undoes edits of the previous one. Throws InputError.
    void take(viewer::StimulusSettings const& stimulus);
    /// Camera of a stimulus, moved along its path.
    /// @param seconds  since the stimulus's onset
    /// @param duration_s  of one round of the path
    gi::Camera camera_at(viewer::StimulusSettings const& stimulus, int width, int height, double seconds,
                         double duration_s) const;

    /// @param scene_s  time of the scene's clips, s. Throws InputError without a scene or a view.
    MadeFrame render(std::vector<viewer::ViewCommand> views, FrameWork work, double scene_s,
                     gi::StopRequest const& stop);

private:
    void change(viewer::Change const& change);
    gi::Camera find_camera(std::string const& name) const;

    mutable std::mutex mutex_;
    gi::Report report_;
    viewer::SceneAccess scenes_;
    viewer::RenderSession session_;
    viewer::Governor governor_;
    std::uint64_t frame_ = 0;
    bool is_edited_ = false;
};

} // namespace bindings
