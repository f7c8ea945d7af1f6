#pragma once
// What a journal says, entry by entry, in the order in which it happened. A journal is the truth of a session: the
// plan's step numbers and these entries decide every table, the state of every staircase, and what is left to do.
// Times are in seconds of the session's monotonic clock unless their names say otherwise; a session that goes on
// later starts its clock anew, and its SessionStarted says when that was.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace study {

/// Of one part of a session: from its start or resumption to its end, or to where it was cut off.
struct SessionStarted {
    std::string experiment, participant_id;
    int participant = 1, session = 1;
    int part = 1;       ///< 1 = the beginning; each resumption counts one more
    std::string utc;    ///< "2026-11-22T08:00:00.000Z"
    double clock_s = 0; ///< the monotonic clock then
    std::string version, git_hash, script_sha256, plan_sha256;
    std::uint64_t seed = 0;
    std::string consent_sha256; ///< of the text that was agreed to; empty = the script has none
    std::vector<std::pair<std::string, std::string>>
        about; ///< provenance: device, driver, display, host, scenes, ...
    bool is_simulated = false;
    double gap_s = 0; ///< since the last entry of the part before, by the wall clock; may be negative
};

/// The display was measured, before the first trial of a part.
struct CalibrationDone {
    int frames = 0;
    double nominal_hz = 0, period_mean_ms = 0, period_sd_ms = 0; ///< nominal 0 = the display says nothing
    std::string onset_method;                                    ///< as in StimulusShown
    bool passed = false;
    std::string reason; ///< why not
};

/// One stimulus of a trial as it was shown.
struct StimulusShown {
    char letter = 'a';
    double onset_s = 0, duration_s = 0;
    std::string onset_method;        ///< oml, wp_presentation, openxr_predicted, swap_finish, simulated
    double onset_uncertainty_ms = 0; ///< the onset lies within +- so much of onset_s, as far as software can tell
    int frames_planned = 0, frames_shown = 0, frames_dropped = 0;
    double render_ms_mean = 0, render_ms_p99 = 0; ///< of the frames rendered for it
    std::string settings_sha256;
};

/// A trial that was carried through, valid or not. A trial that is not here was not done.
struct TrialDone {
    int step = 0;                       ///< of the plan, from 0
    int attempt = 1;                    ///< more than 1: repeated, because the one before was not valid
    std::vector<StimulusShown> shown;   ///< in the order of presentation; the reference has the letter r
    std::optional<double> level;        ///< of what is varied, as it was shown
    std::string response;               ///< the answer's name; of ranking: letters, best first; empty = none came
    std::optional<double> value;        ///< of rating, magnitude, adjustment
    std::optional<bool> is_correct;     ///< none where there is no right answer
    std::optional<double> response_s;   ///< time of the answer
    std::optional<double> reaction_ms;  ///< from the onset of the last stimulus
    double response_uncertainty_ms = 0; ///< of reaction_ms, onset included
    std::string device;                 ///< that answered: "key:left"
    bool is_valid = true;
    std::string reason;        ///< why not: dropped_frames, timeout, skipped, lost_focus, ...
    double bookkeeping_ms = 0; ///< of the trial before: journal and choice of what comes next
};

/// Instructions read, a rest taken, a walk ended.
struct StepDone {
    int step = 0;
    double start_s = 0, end_s = 0;
    std::string reason; ///< empty = as planned; skipped
};

struct QuestionnaireDone {
    int step = 0;
    double start_s = 0, end_s = 0;
    std::vector<std::optional<double>> answers; ///< by item of the questionnaire; none = not answered
};

/// What a participant said about themselves where the script asks for it.
struct ParticipantAsked {
    std::vector<std::pair<std::string, std::string>> answers;
};

/// By the experimenter, or by the machine where something happened that may matter.
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

using JournalEntry = std::variant<SessionStarted, CalibrationDone, TrialDone, StepDone, QuestionnaireDone,
                                  ParticipantAsked, NoteTaken, SessionEnded>;

/// All that is known of one participant's session.
struct SessionRecord {
    std::vector<JournalEntry> entries;
};

} // namespace study
