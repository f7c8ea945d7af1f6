#pragma once
// What people looked at in the scenes of a session: objects, materials and places on surfaces. The surfaces that a
// fixation met are found again with the scene, the edits and the camera of its stimulus.

#include "study/gaze/gaze_analysis.h"
#include "study/tables/result_table.h"
#include "viewer/experiment/looked/surface_heat.h"
#include "viewer/experiment/stimuli/stimulus_source.h"

namespace viewer {

struct LookedAtSettings {
    double accuracy_deg = 0.5; ///< of the eye tracker: standard deviation of each axis
    int rays = 128;            ///< for each fixation
    int threads = 0;           ///< 0 = all
};

struct LookedAt {
    /// dwell (by block, condition and what was looked at), dwell_views (by view), surfaces (files of surface heat),
    /// dwell_left_out (views that could not be followed, by reason).
    std::vector<study::ResultTable> tables;
    std::vector<SurfaceHeat> surfaces;
    std::vector<std::string> cautions;
};

/// Views that count and have enough valid samples. Left out, counted by reason: stimuli in headsets, on walls, in
/// stereo, of AR sessions, of scenes that move by themselves, with settings that are not those recorded, and records of
/// versions that did not note where pictures were.
/// @param analysis  of gaze_of_records(records)
LookedAt looked_at(study::Dataset const& records, study::GazeAnalysis const& analysis, SceneAccess const& scenes,
                   LookedAtSettings const& settings);

} // namespace viewer
