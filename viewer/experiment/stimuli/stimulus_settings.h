#pragma once
// Converts a script's settings of a stimulus to settings of the renderer.
//
// Keys are those of viewer/engine/settings.h, with or without the prefix "gi.", edits of the scene
// (viewer/engine/scene_edits.h), and: scene (a file or a built-in name), camera (of the scene), view (window,
// openxr), and gi.visibility, which selects a method that approximates the visibility of indirect light
// (gi/methods/vpl). Alternatively, only those of an AR session (viewer/experiment/stimuli/ar_stimulus.h).

#include "study/plan/plan.h"
#include "viewer/engine/settings.h"
#include "viewer/experiment/stimuli/ar_stimulus.h"
#include "viewer/experiment/stimuli/physical.h"

namespace viewer {

/// Motion of the camera while a stimulus is shown.
enum class StimulusPath {
    none,
    orbit ///< once around a small horizontal circle with fixed view direction: gives parallax at one place
};

/// Device that shows the stimulus.
enum class StimulusViewer {
    window, ///< or the walls of a display
    headset
};

struct StimulusSettings {
    std::string scene, camera; ///< scene: file or name; camera: of the scene, empty = its first
    StimulusPath path = StimulusPath::none;
    std::optional<StimulusViewer> view; ///< none = as on the command line
    Settings settings;                  ///< complete, with defaults
    std::vector<Change> edits;          ///< edits of the scene
    std::optional<ArStimulus> ar;       ///< if set, replaces all of the above
    PhysicalStimulus physical;          ///< degrees, cd/m2
    std::string sha256; ///< of all of the above as written in the script: equal hashes mean equal pictures
};

/// Throws InputError that names a key or value unknown to the renderer.
/// @param camera  of the block: "", a name or "path:orbit"   @param folder  base of relative paths
StimulusSettings stimulus_settings(study::Patch const& patch, std::string const& camera,
                                   std::filesystem::path const& folder = {});
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
    std::string where; ///< first occurrence, for messages: "faces.yaml: block better, arches"
};

/// Every stimulus of a plan once, by its sha256; stimuli whose level is chosen during the session are included at
/// both ends of the range. Throws InputError, naming the block, if a stimulus is invalid.
std::vector<PlannedStimulus> stimuli_of(study::Script const& script, study::Plan const& plan);

/// Throws InputError, naming the block, unless sizes and luminances can be shown (check_physical).
/// @param model  null = none   @param has_own_views  on walls or in a headset, where they have no meaning
void check_physical_of(std::vector<PlannedStimulus> const& stimuli, study::DisplayModel const* model,
                       bool has_own_views);

} // namespace viewer
