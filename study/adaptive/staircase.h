#pragma once
// Up-down staircases: transformed (Levitt 1971, JASA 49:467) and weighted (Kaernbach 1991, Percept. Psychophys.
// 49:227). After `down` correct responses in a row the level falls by a step, after `up` wrong ones it rises. The
// number of reversals so far, including one at this trial, selects the step.

#include <optional>
#include <vector>

namespace study {

enum class StepKind {
    linear, ///< level -/+ step
    log10,  ///< level / 10^step, level * 10^step
    db      ///< level / 10^(step/20), level * 10^(step/20)
};
enum class InitialRule {
    none,
    one_by_one ///< until the first reversal every response moves the level, as with up = down = 1
};

/// A staircase is finished when it has `reversals` and `min_trials`, or when it has `max_trials`.
struct StopRule {
    int reversals = 0;  ///< 0 = reversals do not stop it
    int min_trials = 0; ///< used with `reversals`
    int max_trials = 0; ///< 0 = no limit
};

struct StaircaseSettings {
    double start = 1;
    std::vector<double> steps{1}; ///< before the first reversal, after it, ...; the last one stays
    StepKind kind = StepKind::linear;
    int up = 1, down = 2;
    double up_ratio = 1; ///< size of steps up relative to steps down
    InitialRule initial = InitialRule::one_by_one;
    double low = -1e300, high = 1e300; ///< of levels
    StopRule stop;
};

struct Reversal {
    int trial = 0; ///< from 0
    double level = 0;
};

class Staircase {
public:
    /// @throws std::invalid_argument no steps, steps or a ratio <= 0, up or down below 1, a start outside the
    /// limits, levels <= 0 for multiplicative steps, a rule that never stops
    explicit Staircase(StaircaseSettings settings);

    /// Level of the next trial.
    double level() const { return level_; }
    bool finished() const;
    /// @throws std::logic_error after it has finished
    void respond(bool correct);
    /// Sets the level of the next trial, for responses that were recorded at other levels.
    void move_to(double level) { level_ = level; }

    StaircaseSettings const& settings() const { return settings_; }
    std::vector<double> const& levels() const { return levels_; }    ///< of the trials so far
    std::vector<Reversal> const& reversals() const { return reversals_; }

private:
    void move(int direction);

    StaircaseSettings settings_;
    double level_;
    int run_ = 0;       ///< correct responses in a row since the last step, negative = wrong ones
    int direction_ = 0; ///< of the last step: -1 down, 1 up, 0 none yet
    std::vector<double> levels_;
    std::vector<Reversal> reversals_;
};

/// The proportion correct at which steps up and down balance: with p_d, the probability that a run
/// of `down` correct responses comes before a run of `up` wrong ones, where p_d = up_ratio / (1 + up_ratio).
/// 0.7071 for 1-up-2-down.
double staircase_target(StaircaseSettings const& settings);

/// Mean level of the last reversals; an early one is dropped if needed to make their number even, so that peaks
/// and valleys have equal weight. Empty without reversals. @param last  maximum number; 0 = all
std::optional<double> mean_of_reversals(Staircase const& staircase, int last = 0);

} // namespace study
