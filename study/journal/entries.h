#pragma once
// Entries of a journal, in the order of events. The journal is the authoritative record of a session: the plan's
// step numbers and these entries determine every table, the state of every staircase, and the remaining steps.
// Times are in seconds of the session's monotonic clock unless their names end in another unit; a resumed session
// restarts its clock, and its SessionStarted records when.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace study {

/// Start of one part of a session. A part runs from a start or resumption to the end or an interruption.
struct SessionStarted {
    std::string experiment, participant_id;
    int participant = 1, session = 1;
    int part = 1;       ///< 1 = the first; each resumption adds one
    std::string utc;    ///< "2026-11-22T08:00:00.000Z"
    double clock_s = 0; ///< monotonic clock at the start
    std::string version, git_hash, script_sha256, plan_sha256;
    std::uint64_t seed = 0;
    std::string consent_sha256; ///< of the consent text; empty = the script has none
    /// Provenance: device, driver, display, host, scenes, ...
    std::vector<std::pair<std::string, std::string>> about;
    bool is_simulated = false;
    double gap_s = 0; ///< since the last entry of the previous part, by the wall clock; may be negative
};

/// Measurement of the display before the first trial of a part.
struct CalibrationDone {
    int frames = 0;
    double nominal_hz = 0, period_mean_ms = 0, period_sd_ms = 0; ///< nominal 0 = not reported by the display
    std::string onset_method;                                    ///< as in StimulusShown
    bool passed = false;
    std::string reason; ///< why not
};

/// Presentation of one stimulus of a trial.
struct StimulusShown {
    char letter = 'a';
    double onset_s = 0, duration_s = 0;
    std::string onset_method;        ///< oml, wp_presentation, openxr_predicted, swap_finish, simulated
    double onset_uncertainty_ms = 0; ///< +- range of onset_s, as far as software can measure it
    int frames_planned = 0, frames_shown = 0, frames_dropped = 0;
    double render_ms_mean = 0, render_ms_p99 = 0; ///< of the frames rendered for it
    std::string settings_sha256;
    // With a display model only:
    std::optional<double> mean_cd_m2{}, peak_cd_m2{}; ///< of its first frame, as shown
    /// Of its first frame: brighter than the display or darker than its black.
    std::optional<int> clipped_pixels{};
    std::optional<double> width_deg{}, height_deg{};
    // In windows only: the rectangle of its picture, from the window's top left corner, px.
    std::optional<int> left_px{}, top_px{}, width_px{}, height_px{};
    // With `frames: shown` only:
    std::string frames_kind{};         ///< "shown"; empty: exact
    std::optional<int> frames_drawn{}; ///< of frames_shown: its surfaces were drawn for a newer pose
    /// At the onset: since the pose for which the light of its first frame was rendered.
    std::optional<double> light_age_ms{};
};

/// A sound that a cue of the trial played, or should have played.
struct SoundPlayed {
    std::string sound;             ///< its name in the script
    std::string at;                ///< fixation, or the letters of the stimuli with which it was due
    double event_s = 0;            ///< onset of those
    double offset_ms = 0;          ///< of the cue: wanted from event_s to the sound
    std::optional<double> onset_s; ///< when its first sample left, as the device says; none = it was not played
    double duration_s = 0;
    int underruns = 0;   ///< times that the device ran out of samples while it played
    std::string missing; ///< why it was not played: trial ended, without sound, device failed, too many sounds
};

/// How much later it came than wanted; none = it was not played.
inline std::optional<double> error_ms(SoundPlayed const& s)
{
    return s.onset_s ? std::optional(1e3 * (*s.onset_s - s.event_s) - s.offset_ms) : std::nullopt;
}

/// Reasons of trials with an answer that never counts: before min_response_ms, after max_response_ms.
inline constexpr char const *kAnticipation = "anticipation", *kTooSlow = "too_slow";

/// A trial that ran to its end, valid or not. A trial without this entry was not done.
struct TrialDone {
    int step = 0;                       ///< of the plan, from 0
    int attempt = 1;                    ///< more than 1: repeated because the previous attempt was invalid
    std::vector<StimulusShown> shown;   ///< in the order of presentation; the reference has the letter r
    std::optional<double> level;        ///< of the varied setting, as shown
    std::string response;               ///< the answer's name; for ranking letters, best first; empty = no answer
    std::optional<double> value;        ///< of rating, magnitude, adjustment
    std::optional<bool> is_correct;     ///< none if there is no correct answer
    std::optional<double> response_s;   ///< time of the answer
    std::optional<double> reaction_ms;  ///< from the onset of the last stimulus
    double response_uncertainty_ms = 0; ///< of reaction_ms, including that of the onset
    std::string device;                 ///< input that gave the answer: "key:left"
    bool is_valid = true;
    /// Why not: dropped_frames, timeout, anticipation, too_slow, skipped, lost_focus, no_sound, ...
    std::string reason;
    std::string chosen;                ///< what was chosen when it came: a pair, "best/fair", or levels of further
                                       ///< varied settings, "camera.fov=40"; else empty
    std::vector<SoundPlayed> sounds{}; ///< in the order in which they were due
    double bookkeeping_ms = 0;         ///< time after the previous trial for journal and choice of the next step
    // Of gaze, while stimuli were visible; none if gaze was not recorded:
    std::optional<int> gaze_samples{}, gaze_valid{};
    std::optional<int> gaze_dropped{}; ///< missing between samples
    /// Samples near the place of fixation; none without gaze.hold or gaze.start.
    std::optional<int> gaze_fixating{};
};

/// Instructions, a rest or a walk has ended.
struct StepDone {
    int step = 0;
    double start_s = 0, end_s = 0;
    std::string reason; ///< empty = as planned; skipped
};

/// The participant has left an item of a questionnaire that is not complete yet: what counts if it never will be,
/// and where it continues when the session is resumed. QuestionnaireDone repeats the last answers.
struct ItemAnswered {
    int step = 0;
    double time_s = 0;
    int item = 0;                 ///< of the questionnaire, from 0
    std::optional<double> answer; ///< none = not answered, or a text
    std::string text;             ///< of an item of type text; empty = not answered
};

struct QuestionnaireDone {
    int step = 0;
    double start_s = 0, end_s = 0;
    std::vector<std::optional<double>> answers; ///< by item of the questionnaire; none = not answered
    std::vector<std::string> texts{}; ///< by item; empty = not answered, or no text; none if it asks for no text
};

/// Answers of a participant to the script's questions about the participant.
struct ParticipantAsked {
    std::vector<std::pair<std::string, std::string>> answers;
};

/// A note by the experimenter, or by the program about an event that may matter.
struct NoteTaken {
    double time_s = 0;
    std::string kind; ///< note, pause, resume, skip, abort, display_lost, clock_changed, warning
    std::string text;
};

struct SessionEnded {
    double time_s = 0;
    std::string utc;
    bool is_complete = false; ///< every step of the plan is done
    std::string reason;
};

using JournalEntry = std::variant<SessionStarted, CalibrationDone, TrialDone, StepDone, ItemAnswered,
                                  QuestionnaireDone, ParticipantAsked, NoteTaken, SessionEnded>;

/// The record of one participant's session.
struct SessionRecord {
    std::vector<JournalEntry> entries;
};

} // namespace study
