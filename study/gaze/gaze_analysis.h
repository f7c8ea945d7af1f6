#pragma once
// What the gaze of recordings did while something was shown.

#include "study/gaze/gaze_recording.h"
#include "study/gaze/main_sequence.h"

namespace study {

struct GazeAnalysisSettings {
    GazeEventSettings events;
    double least_valid = 0.7; ///< views with a smaller share of valid samples are marked, and left out of means
};

/// A fixation, as far as it is in a view.
struct SeenFixation {
    Fixation const* fixation;
    int number;     ///< in the view, from 1
    double dwell_s; ///< of it, within the view
};

struct ViewedGaze {
    GazeView const* view;
    double valid_share = 0; ///< of its time
    bool is_usable = false; ///< valid_share is enough
    double lost_s = 0;      ///< of losses that are not bridged, within the view
    int losses = 0;
    std::vector<SeenFixation> fixations;  ///< that overlap it
    std::vector<Saccade const*> saccades; ///< that begin in it
    double path_deg = 0;                  ///< sum of the saccades' amplitudes
    double first_saccade_ms = NAN;        ///< from the beginning of the view; NaN = none
};

struct AnalysedGaze {
    GazeRecording recording;
    GazeEvents events;
    double valid_share = 0; ///< of the recording, from its first to its last sample
    MainSequence sequence;
    std::vector<ViewedGaze> views; ///< pointers are into this
};

struct GazeAnalysis {
    GazeAnalysisSettings settings;
    std::vector<std::unique_ptr<AnalysedGaze const>> recordings; ///< addresses stay
    std::vector<std::string> cautions; ///< why results may be doubtful, what was left out
    std::vector<InputFile> inputs;
};

GazeAnalysis analyse_gaze(GazeRecordings recordings, GazeAnalysisSettings const& settings);

} // namespace study
