#pragma once
// Checks stimuli before a session: their scenes are loaded, cameras and edits looked up in them, and one tiny
// picture of each is rendered, without a window.

#include "gi/core/progress.h"
#include "viewer/experiment/stimuli/physical.h"
#include "viewer/experiment/stimuli/stimulus_settings.h"
#include "viewer/experiment/stimuli/stimulus_source.h"

#include <functional>
#include <set>

namespace viewer {

/// The distinct stimuli of plans, by the sha256 of their settings; those of AR sessions are left out.
class StimulusCollection {
public:
    /// @param wrong  settings already reported as wrong; ignored when checking stimuli
    StimulusCollection(study::Script const& script, std::set<std::pair<std::string, std::string>> wrong)
        : script_(script), wrong_(std::move(wrong))
    {
    }
    /// Adds those of a plan; what is wrong with one is added to the mistakes at its block.
    void add(study::Plan const& plan, study::Mistakes& m);
    std::vector<PlannedStimulus> list() const;
    /// True if one has a size, place or luminance in physical units.
    bool need_display_model() const;

private:
    void add(int block, study::Stimulus const& stimulus, study::Mistakes& m);

    study::Script const& script_;
    std::set<std::pair<std::string, std::string>> wrong_;
    std::set<std::tuple<int, std::vector<int>, bool, std::optional<double>, std::vector<double>>> seen_;
    std::map<std::string, PlannedStimulus> all_;
};

struct StimulusCheckOptions {
    bool renders = true;
    int threads = 0; ///< 0 = all
    gi::StopRequest const* stop = nullptr;
    /// @param share  0..1   @param what  the stimulus
    std::function<void(double share, std::string const& what)> progress = {};
    std::optional<ShownOn> shown_on = {}; ///< if set, sizes, places and luminances must be possible on it
    /// Where the script gives a setting this value; {0, 0} = unknown.
    std::function<study::Place(std::string const& key, std::string const& value)> place_of = {};
};

struct StimulusCheckResult {
    std::size_t scenes = 0, stimuli = 0, rendered = 0;
};

/// Throws gi::Interrupted within 0.2 s of a stop request. A scene that cannot be loaded is reported once.
StimulusCheckResult find_wrong_stimuli(std::vector<PlannedStimulus> stimuli, SceneAccess const& scenes,
                                       StimulusCheckOptions const& options, study::Mistakes& m);

} // namespace viewer
