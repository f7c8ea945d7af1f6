#pragma once
// Sessions from trials that were not planned here: script, plans and records as if they had been.

#include "study/imported/trial_table.h"

namespace study {

struct MadeTrial {
    std::string participant, run;
    std::vector<std::string> factors; ///< level of each factor
    std::vector<std::string> items;   ///< first and second of a pair; the judged item; empty = only factors
    std::string response;
    std::optional<double> value, level, reaction_ms;
    std::optional<bool> is_correct;
    bool is_signal = true;
};

struct MadeExperiment {
    std::string id, file;
    Task task = Task::pair;
    TrialDetail detail = TrialDetail::trials;
    std::vector<std::string> factors; ///< names
    std::vector<MadeTrial> trials;
    Scale scale = Scale::linear;
    bool harder_up = false;
    std::string level_name = "level";
    std::string participant_column; ///< columns with the ids, as given; empty = one person
    std::vector<std::string> notes;
};

/// A factor whose level is the same in all trials of each participant, and differs between them, is one between
/// participants; notes name those that are within them although ids seem to be used for several people. Levels are in numeric order, or in that of their appearance.
ImportedTable sessions_of(MadeExperiment const& made);

} // namespace study
