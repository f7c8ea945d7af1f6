#pragma once
// Converts a script's settings of a stimulus to settings of the renderer.
//
// Keys are those of viewer/study/setting_lookup.h, or alternatively only those of an AR session
// (viewer/experiment/stimuli/ar_stimulus.h).

#include "gi/core/error.h"
#include "study/plan/plan.h"
#include "viewer/experiment/stimuli/ar_stimulus.h"
#include "viewer/study/physical_setting.h"
#include "viewer/study/setting_lookup.h"

namespace viewer {

/// Device that shows the stimulus.
enum class StimulusViewer {
    window, ///< or the walls of a display
    headset
};

struct StimulusSettings {
    std::string scene, camera; ///< scene: file or name; camera: of the scene, empty = its first
    StimulusPath path = StimulusPath::none;
    double raise_m = 0;                 ///< of the camera above its own place, along the world's up (+Y)
    std::optional<double> fov_deg;      ///< vertical field of view; none = the camera's
    std::optional<StimulusViewer> view; ///< none = as on the command line
    Settings settings;                  ///< complete, with defaults
    std::vector<Change> edits;          ///< edits of the scene
    std::optional<ArStimulus> ar;       ///< if set, replaces all of the above
    PhysicalStimulus physical;          ///< degrees, cd/m2
    std::string sha256; ///< hash of all of the above as written in the script: equal hashes mean equal pictures
};

/// Throws InputError that names a key or value unknown to the renderer.
/// @param camera  of the block: "", a name or "path:orbit"   @param folder  base of relative paths
StimulusSettings stimulus_settings(study::Patch const& patch, std::string const& camera,
                                   std::filesystem::path const& folder = {},
                                   MadeFor made_for = MadeFor::this_version);
/// Settings of a stimulus in a script's block. Paths of AR sessions are relative to the script; those of scenes to
/// the script or else to the current folder.
StimulusSettings stimulus_settings(study::Script const& script, study::Block const& block,
                                   study::Stimulus const& stimulus);

/// Name for messages: the scene, or the file of the AR session.
std::string name_of(StimulusSettings const& stimulus);

/// Block with default values, for steps of the sequence that belong to no block.
study::Block plain_block(study::Script const& script);

struct PlannedStimulus {
    StimulusSettings settings;
    std::string what;       ///< "block better, arches"
    std::string where;      ///< first occurrence, for messages: "faces.yaml: block better, arches"
    gi::TextLocation place; ///< of its block
    study::Patch patch;     ///< all settings as written, `camera` of the block included
};

} // namespace viewer
