#pragma once
#include "study/script/script.h"
#include "study/stats/questplus.h"
#include "study/stats/staircase.h"

#include <variant>

namespace study {

/// One run of a staircase or of QUEST+ as a script describes it, in levels of what is varied.
///
/// Staircases step on the scale of `compare`; downwards is harder. QUEST+ has the Weibull function of levels,
/// 1 - exp(-(x / threshold)^slope), or the normal or logistic one of the scale.
class AdaptiveRun {
public:
    /// @throws ScriptError in `file` where the procedure cannot be run: a Weibull function of levels that are not
    /// above 0
    AdaptiveRun(Procedure const& procedure, Compare const& compare, std::string const& file);

    bool finished() const { return is_finished_; }
    /// Of the next trial.
    double level() const { return level_; }
    /// After a valid trial at level().
    void respond(bool is_correct);

private:
    struct Quest {
        QuestPlus quest;
        std::vector<double> levels;
        std::size_t next = 0;
        int left = 0;
    };
    void choose();

    Scale scale_;
    double sign_; ///< of the staircase's axis: -1 where a higher level is harder
    std::variant<Staircase, Quest> method_;
    double level_ = 0;
    bool is_finished_ = false;
};

/// All levels that a run may ask for, rising, as shown: the stimuli of QUEST+; of a staircase its start and
/// everything that its steps lead to within the range. Staircases that may ask for more than 10,000 give an empty
/// list.
std::vector<double> reachable_levels(Procedure const& procedure, Compare const& compare);

} // namespace study
