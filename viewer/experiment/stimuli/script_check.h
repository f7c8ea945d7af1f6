#pragma once
// Checks an experiment before participants come: the script, its plans, settings and stimuli.
// All mistakes are reported at once.

#include "viewer/experiment/stimuli/stimulus_check.h"
#include "viewer/study/study_script.h"

namespace viewer {

struct ScriptCheckOptions {
    StimulusCheckOptions stimuli;
    bool any_settings = false; ///< settings are those of another presenter: they are not looked up
};
struct CheckedScript {
    study::Plan longest; ///< the plan that is expected to take longest
    int plans = 0;       ///< made: of the first 2,000 participants
    std::size_t ar_stimuli = 0;
    StimulusCheckResult stimuli;
    std::vector<std::string> idle_settings; ///< that are varied, one line each
    bool needs_display_model = false; ///< stimuli have physical units
};

/// Adds blocks whose rules of gaze cannot be fulfilled.
/// @param is_measured  true if gaze is measured  @param model  null = none
void find_wrong_gaze(study::Script const& script, bool is_measured, study::DisplayModel const* model,
                     study::Mistakes& m);

/// Adds what is wrong to read.mistakes. Throws gi::Interrupted.
CheckedScript check_script(ScriptToCheck& read, SceneAccess const& scenes, ScriptCheckOptions const& options);

} // namespace viewer
