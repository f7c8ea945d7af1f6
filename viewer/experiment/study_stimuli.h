#pragma once
// What stimuli are made of: the scenes and AR sessions that a script names.

#include "study/plan/plan.h"
#include "viewer/experiment/stimulus_source.h"
#include "viewer/study/study_script.h"

#include <set>
#include <string>
#include <utility>

namespace viewer {

/// Scenes as every command reads them.
SceneAccess study_scenes();

/// Stimuli that are made of AR sessions, over several plans, each once.
class ArStimulusCheck {
public:
    explicit ArStimulusCheck(LoadedScript const& loaded) : loaded_(loaded) {}
    void add(study::Plan const& plan);
    /// Reads all that they name; no picture is made. Throws ScriptError at the setting that is to blame; what is
    /// wrong within a session is said with its own place.
    void check() const;
    std::size_t count() const { return patches_.size(); }

private:
    void add(study::Block const& block, study::Stimulus const& stimulus);

    LoadedScript const& loaded_;
    std::set<std::pair<study::Patch, std::string>> patches_; ///< settings and camera
};

} // namespace viewer
