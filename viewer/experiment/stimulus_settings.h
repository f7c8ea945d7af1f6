#pragma once
// From the settings that a script gives a stimulus to those of the renderer.
//
// Keys are those of viewer/engine/settings.h, with or without "gi." before them, edits of the scene
// (viewer/engine/scene_edits.h), and: scene (a file or a built-in name), camera (of the scene), view (window,
// openxr), and gi.visibility, which chooses a method that approximates the visibility of indirect light
// (gi/methods/vpl). Or those of an AR session (viewer/experiment/ar_stimulus.h), and no others.

#include "study/plan/plan.h"
#include "viewer/engine/settings.h"
#include "viewer/experiment/ar_stimulus.h"

namespace viewer {

/// How the camera moves while a stimulus is shown.
enum class StimulusPath {
    none,
    orbit ///< once round a small horizontal circle, looking the same way: parallax without a new place
};

/// What it is seen in.
enum class StimulusViewer {
    window, ///< or the walls of a display
    headset
};

struct StimulusSettings {
    std::string scene, camera; ///< scene: file or name; camera: of the scene, empty = its first
    StimulusPath path = StimulusPath::none;
    std::optional<StimulusViewer> view; ///< none = as the command line says
    Settings settings;                  ///< whole: what is not said is as it is by default
    std::vector<Change> edits;          ///< of the scene
    std::optional<ArStimulus> ar;       ///< in place of all that
    std::string sha256; ///< of all this as the script writes it: the same digits, the same pictures
};

/// Throws InputError on a key or value that the renderer does not know, naming it.
/// @param camera  of the block: "", a name or "path:orbit"   @param folder  that files are relative to
StimulusSettings stimulus_settings(study::Patch const& patch, std::string const& camera,
                                   std::filesystem::path const& folder = {});
/// Of a script's block. AR sessions are relative to the script; so are scenes, or else to the current folder.
StimulusSettings stimulus_settings(study::Script const& script, study::Block const& block,
                                   study::Stimulus const& stimulus);

/// For messages: the scene, or the file of the AR session.
std::string name_of(StimulusSettings const& stimulus);

/// What a step of the sequence has that belongs to no block.
study::Block plain_block(study::Script const& script);

struct PlannedStimulus {
    StimulusSettings settings;
    std::string where; ///< "faces.yaml: block better, arches", for messages; of several the first
};

/// Every stimulus of a plan once, by its sha256; those whose level is chosen when the trial comes at the ends of
/// its range. Throws InputError naming the block where one cannot be.
std::vector<PlannedStimulus> stimuli_of(study::Script const& script, study::Plan const& plan);

} // namespace viewer
