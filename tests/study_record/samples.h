#pragma once
#include "study/journal/entries.h"
#include "study/numeric/random.h"

namespace study::test {

/// One journal entry of every kind, with every field set.
inline std::vector<JournalEntry> entries_of_every_kind()
{
    SessionStarted started{"bounces", "P003",
                           3,         1,
                           2,         "2026-11-22T08:00:00.000Z",
                           12.5,      "0.1.0",
                           "1a2b3c4", "aa",
                           "bb",      18446744073709551615u,
                           "cc",      {{"device", "GPU \"x\""}, {"b", ""}},
                           true,      -0.25};
    StimulusShown const shown{'b', 1.0 / 3, 6.1, "oml", 0.2, 360, 359, 1, 8.25, 11.5, "dd"};
    TrialDone trial;
    trial.step = 41;
    trial.attempt = 2;
    trial.shown = {shown, shown};
    trial.shown[1].letter = 'r';
    trial.shown[1].frames_kind = "shown";
    trial.shown[1].frames_drawn = 350;
    trial.shown[1].light_age_ms = 81.25;
    trial.level = 362.03867196751236;
    trial.response = "first";
    trial.value = -0.0;
    trial.is_correct = false;
    trial.response_s = 5e-324;
    trial.reaction_ms = 1e308;
    trial.response_uncertainty_ms = 0.1;
    trial.device = "key:left";
    trial.is_valid = false;
    trial.reason = "dropped_frames";
    trial.bookkeeping_ms = 0.123456789012345678;
    trial.sounds = {{"beep", "ab", 1.0 / 3, -200, 0.14, 0.05, 1, ""},
                    {"beep", "fixation", 2, 0, {}, 0.05, 0, "trial ended"}};
    return {started,
            CalibrationDone{600, 59.94, 16.683, 0.021, "oml", false, "the period varies"},
            trial,
            TrialDone{},
            StepDone{7, 1.5, 2.5, "skipped"},
            QuestionnaireDone{8, 0, 1, {3.0, std::nullopt, 0.1}},
            ParticipantAsked{{{"age_band", "20-29"}, {"vision", "normal\n\t\"quoted\" \\ \xe2\x82\xac"}}},
            NoteTaken{1.25, "pause", "the telephone rang"},
            QuestionnaireDone{8, 0, 1, {std::nullopt, 2.0}, {"\"Ça\", he said,\nłódź", ""}},
            ItemAnswered{8, 0.5, 2, 3.0, ""},
            ItemAnswered{8, 0.5, 3, std::nullopt, "nan"},
            SessionEnded{100, "2026-11-22T09:00:00.000Z", true, ""}};
}

} // namespace study::test
