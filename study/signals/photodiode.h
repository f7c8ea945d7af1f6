#pragma once
// Compares the signal of a photodiode on the sync patch, or a recording of the sounds,
// with the onsets in a session's journal: lag and jitter of the display or the sound device,
// missed and doubled flashes, drift between the clocks.

#include <optional>
#include <string>
#include <vector>

namespace study {

/// A recorded signal: one time and one value a sample.
struct DiodeSignal {
    std::vector<double> time_s;  ///< rising
    std::vector<double> light;   ///< of the photodiode, any unit
    std::vector<double> trigger; ///< a second channel that is high from the marker of each onset; empty = none
    double rate_hz = 0;          ///< median
};

/// An onset that the journal reports.
struct ReportedOnset {
    double time_s = 0, duration_s = 0; ///< session's clock
    double uncertainty_ms = 0;
    std::string method; ///< as StimulusShown
    std::string place;  ///< for tables: "step 3, ab"
};

enum class DiodeClock {
    own, ///< the recorder's: its offset and drift are fitted, so the mean lag cannot be measured, only its jitter
    session, ///< the session's: samples have the times of the same steady clock
    trigger  ///< the recorder's, and the second channel says when the program reported each onset
};

struct DiodeSettings {
    DiodeClock clock = DiodeClock::own;
    double hold_ms = 10;       ///< gaps and flashes that are shorter do not count (PWM of backlights, noise)
    double most_lag_ms = 300;  ///< a flash later than this after its onset belongs to none
    double most_early_ms = 50; ///< a flash earlier than this before its onset belongs to none
};

/// A bright interval of the signal.
struct Flash {
    double start_s = 0, end_s = 0;
};
struct FlashesFound {
    std::vector<Flash> flashes;
    double dark = 0, bright = 0; ///< levels
    double noise = 0;            ///< standard deviation around the levels, as a share of bright - dark
    int glitches = 0;            ///< bright intervals shorter than hold_ms, left out
};
/// Edges are where the signal crosses the middle between both levels, interpolated; a change of state needs a
/// crossing of a quarter beyond it. @throws gi::InputError the signal does not have two levels
FlashesFound find_flashes(std::vector<double> const& time_s, std::vector<double> const& light, double hold_ms);

struct LagSummary {
    std::string method;
    int count = 0;
    double mean_ms = 0;    ///< NaN if the clock is `own`
    double mean_se_ms = 0; ///< standard error of the mean
    double sd_ms = 0;      ///< jitter, after the drift is removed (own, trigger: of the clocks)
    double least_ms = 0, p5_ms = 0, median_ms = 0, p95_ms = 0, most_ms = 0; ///< own: from the mean
};
struct MatchedOnset {
    std::size_t onset = 0;
    double lag_ms = 0;      ///< as LagSummary
    double duration_ms = 0; ///< of the flash
};
struct DiodeResult {
    FlashesFound found;
    std::vector<LagSummary> methods; ///< by name, then "all" if there are several
    std::vector<MatchedOnset> matched;
    std::vector<std::size_t> missed;        ///< onsets without a flash
    std::vector<std::size_t> doubled;       ///< onsets with more than one
    int extra = 0;                          ///< flashes that belong to no onset
    double drift_ppm = 0, drift_se_ppm = 0; ///< of the recorder's clock against the session's; > 0: it runs fast
    double offset_s = 0;                    ///< recorder's time of the session's time 0; session: 0
    std::vector<std::string> warnings;
};

/// @throws gi::InputError no onset, no flash, no alignment, or no trigger channel
DiodeResult compare_with_onsets(DiodeSignal const& signal, std::vector<ReportedOnset> const& onsets,
                                DiodeSettings const& settings);

/// A recorded sound as a signal of two levels for compare_with_onsets(): 1 from the first sample that is louder
/// than `threshold` times the loudest one, until none was for hold_ms. @throws gi::InputError it is silent, or the
/// pauses are louder than a third of that
DiodeSignal heard(DiodeSignal signal, double threshold, double hold_ms);

/// Reads PCM (8 to 32 bits) or float WAV; channel 1 is the photodiode, 2 the trigger. The bytes of a cut-off file
/// are read as far as they go. @throws gi::InputError
DiodeSignal read_wav(std::string const& bytes, std::string const& file);
/// Reads a table with columns t_s (or time_s, t_ms), light (or value, photodiode, sound) and trigger (optional).
/// @throws gi::InputError with file:line:column
DiodeSignal read_diode_csv(std::string const& text, std::string const& file);

} // namespace study
