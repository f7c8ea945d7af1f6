#pragma once
// AR sessions that a script uses for stimuli.

#include "study/plan/plan.h"
#include "viewer/experiment/stimuli/physical.h"
#include "viewer/experiment/stimuli/stimulus_source.h"
#include "viewer/study/study_script.h"

#include <set>
#include <string>
#include <utility>

namespace viewer {

/// Collects the stimuli from AR sessions over several plans, each once, and checks them.
class ArStimulusCheck {
public:
    /// @param shown_on  if set, sizes, places and luminances must be possible on it
    explicit ArStimulusCheck(LoadedScript const& loaded, std::optional<ShownOn> shown_on = {})
        : loaded_(loaded), shown_on_(shown_on)
    {
    }
    void add(study::Plan const& plan);
    /// Reads all their files without making pictures. Throws ScriptError at the setting that is the cause; errors
    /// within a session are reported with their own position.
    void check() const;
    /// As check(), but adds everything that is wrong.
    void find_wrong(study::Mistakes& m) const;
    std::size_t count() const { return patches_.size(); }

private:
    void add(study::Block const& block, study::Stimulus const& stimulus);
    void check_one(study::Patch const& patch, std::string const& camera) const;

    LoadedScript const& loaded_;
    std::optional<ShownOn> shown_on_;
    std::set<std::pair<study::Patch, std::string>> patches_; ///< settings and camera
};

} // namespace viewer
