#pragma once
// Chooses the level of each trial by a staircase or by QUEST+.

#include "study/adaptive/questplus.h"
#include "study/adaptive/staircase.h"
#include "study/script/script.h"

#include <variant>

namespace study {

/// One run of a staircase or of QUEST+ as a script describes it, in levels of the varied setting.
///
/// Staircases step on the scale of `compare`; downwards is harder. QUEST+ uses the Weibull function of levels,
/// 1 - exp(-(x / threshold)^slope), or the normal or logistic function of the scale.
class AdaptiveRun {
public:
    /// @throws ScriptError in `file` if the procedure cannot be run: a Weibull function with levels <= 0
    AdaptiveRun(Procedure const& procedure, Compare const& compare, std::string const& file);

    bool finished() const { return is_finished_; }
    /// Level of the next trial.
    double level() const { return level_; }
    /// Levels of the further settings of `compare`; empty = there are none.
    std::vector<double> const& also() const { return also_; }
    /// Call after a valid trial at level().
    void respond(bool is_correct);
    /// Takes the levels that a trial had for those of the next one, where a version with other rules chose them.
    /// @throws std::invalid_argument if the procedure cannot have them
    void choose(double level, std::vector<double> const& also);

private:
    struct Quest {
        QuestPlus quest;
        std::vector<double> levels;
        std::size_t next = 0;
        int left = 0;
    };
    struct QuestMany {
        QuestPlusMany quest;
        std::size_t next = 0;
        int left = 0;
    };
    using Chooser = std::variant<Staircase, Quest, QuestMany>;
    static Chooser method_for(Procedure const& procedure, Compare const& compare);
    void choose_next();

    Scale scale_;
    double sign_; ///< of the staircase's axis: -1 if a higher level is harder
    Chooser method_;
    double level_ = 0;
    std::vector<double> also_;
    bool is_finished_ = false;
};

/// All levels that a run can present, in rising order: the stimuli of QUEST+; for a staircase its start and all
/// levels that its steps can reach within the range. Empty for staircases with more than 10,000 such levels.
std::vector<double> reachable_levels(Procedure const& procedure, Compare const& compare);

} // namespace study
