#pragma once
// The likelihood of several observers' answers at levels, integrated over their thresholds: see group_threshold.h.

#include "study/numeric/special.h"
#include "study/stats/curve_likelihood.h"
#include "study/stats/group_threshold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace study {

constexpr double kLeastThresholdSd = 0.002; ///< between observers, in ranges

/// All in units of the range from its centre: mean and log deviation of thresholds,
/// log scale, logits of lapse, eta, guess.
struct ThresholdPart {
    enum Index { kMean, kSpread, kScale, kLapse, kEta, kGuess, kCount };
};
using Thresholds = std::array<double, ThresholdPart::kCount>;

inline double spread_of(double parameter) { return kLeastThresholdSd + std::exp(parameter); }

struct ThresholdPerson {
    std::vector<LevelAnswers> levels;
    double guess = 0.5, mode = 0; ///< where the last search for the mode ended
    double mean = 0;              ///< of the threshold under the last population
    double information = 0;
    double surprises = 0; ///< sum over trials of p (1 - p)
    Thresholds score{};   ///< derivatives of this observer's log-likelihood
};

class ThresholdMarginal {
    using enum ThresholdPart::Index;

public:
    ThresholdMarginal(std::span<ObserverLevels const> observers, GroupThresholdSettings const& s);

    std::vector<ThresholdPerson> const& people() const { return people_; }
    bool is_repeated() const { return is_repeated_; }
    double range() const { return range_; }
    double centre() const { return centre_; }
    bool is_all(bool right) const
    {
        return std::all_of(people_.begin(), people_.end(), [&](ThresholdPerson const& p) {
            return std::all_of(p.levels.begin(), p.levels.end(),
                               [&](LevelAnswers const& l) { return l.right == (right ? l.trials : 0); });
        });
    }

    /// Penalised log-likelihood and its gradient; -infinity where the curve cannot reach the proportion.
    double operator()(Thresholds const& at, Thresholds& gradient);

    double lapse_of(Thresholds const& at) const { return s_.lapse.value_or(inverse_logit(at[kLapse])); }

private:
    void add(ObserverLevels const& o);
    std::optional<LevelCurve> curve_of(Thresholds const& at, double guess) const;
    /// One observer's log-likelihood by Gauss-Hermite quadrature around the mode;
    /// sets what is known of the observer.
    double integrate(ThresholdPerson& p, Thresholds const& at, LevelCurve const& c) const;

    GroupThresholdSettings s_;
    double centre_ = 0, range_ = 1;
    std::vector<ThresholdPerson> people_;
    bool is_repeated_ = false;
};

} // namespace study
