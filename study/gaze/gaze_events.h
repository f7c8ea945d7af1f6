#pragma once
// Fixations and saccades in samples of gaze.
//
// I-VT, by velocity: Salvucci and Goldberg 2000, Identifying fixations and saccades in eye-tracking protocols
// (Proc. ETRA, 71-78), with the merging, the shortest fixation and the defaults of Olsen 2012, The Tobii I-VT
// fixation filter (Tobii Technology). I-DT, by dispersion: Salvucci and Goldberg 2000.
// Angles are those between rays from the eyes. Pursuit of what moves is not told apart: I-VT takes it as fixation
// while it is slower than the threshold.

#include "study/signals/gaze.h"

namespace study {

enum class GazeMethod { ivt, idt };

struct GazeEventSettings {
    GazeMethod method = GazeMethod::ivt;
    double velocity_deg_s = 30; ///< I-VT: faster is a saccade (Olsen 2012)
    /// Velocity is the slope of directions over this long, by least squares (Olsen 2012: 20 ms, of its ends), and
    /// over the neighbouring samples where these are further apart.
    double window_ms = 20;
    double dispersion_deg = 1; ///< I-DT: width plus height of a fixation (Salvucci and Goldberg: 0.5 to 1)
    /// Shorter ones are left out. None: 60 for I-VT (Olsen 2012), 100 for I-DT (Salvucci and Goldberg: 100 to 200).
    std::optional<double> min_fixation_ms;
    double merge_ms = 75, merge_deg = 0.5; ///< I-VT: fixations nearer in time and direction are one (Olsen 2012)
    /// Lost samples end what was going on if there is none for longer (Olsen 2012), or, where more than one and more
    /// than the window is missing, if gaze has moved by more than merge_deg meanwhile.
    double bridge_ms = 75;
    double shortest_ms() const { return min_fixation_ms.value_or(method == GazeMethod::ivt ? 60 : 100); }
};

struct Fixation {
    double start_s = 0, end_s = 0;
    double x_px = 0, y_px = 0; ///< mean, from the screen's centre
    double rms_deg = 0;        ///< of the samples' directions from their mean
    double pupil_mm = NAN;     ///< mean; NaN = not measured
    int samples = 0;
    bool is_cut = false; ///< begins or ends where samples are lost, or with the recording
};

struct Saccade {
    double start_s = 0, end_s = 0;
    double from_x_px = 0, from_y_px = 0, to_x_px = 0, to_y_px = 0; ///< means over the window before and after it
    double amplitude_deg = 0;                                      ///< between these
    double peak_deg_s = 0; ///< greatest velocity, blunted by the window
    bool is_cut = false;   ///< as Fixation: a part of it is missing; or its duration is unknown (I-DT)
};

/// Time without valid samples that is not bridged.
struct GazeLoss {
    double start_s = 0, end_s = 0;
};

struct GazeEvents {
    std::vector<Fixation> fixations;
    std::vector<Saccade> saccades;
    std::vector<GazeLoss> losses;
    double step_s = NAN;     ///< median, between samples
    int bridged = 0;         ///< losses that were bridged
    int merged = 0;          ///< fixations that became part of the one before
    int short_fixations = 0; ///< left out, shorter than the shortest
    int alone = 0;           ///< valid samples without a valid neighbour: they are in neither
};

/// Ends of events are midway between samples, and half a step beyond the samples beside a loss.
/// @param samples  of clean_gaze   @param screen  with a distance
GazeEvents find_gaze_events(std::vector<GazeSample> const& samples, ScreenGeometry const& screen,
                            GazeEventSettings const& settings);

/// Share of a stretch of time for which valid samples stand: each for the time to midway to its neighbours, at most
/// 3/4 of a step to either side. @return 0 to 1
double valid_share(std::vector<GazeSample> const& samples, double step_s, double start_s, double end_s);

} // namespace study
