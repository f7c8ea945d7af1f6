#pragma once
// Psychometric functions by maximum likelihood (Wichmann & Hill 2001, Percept. Psychophys. 63:1293).

#include "study/adaptive/psychometric_curve.h"
#include "study/numeric/matrix.h"

#include <span>
#include <string>

namespace study {

/// Trials at one level.
struct LevelCount {
    double level = 0;
    double correct = 0; ///< or "yes"
    double trials = 0;
};

/// A rate that is fixed, or fitted within [0, limit].
struct Rate {
    double value = 0;
    double limit = 0; ///< > 0 = fitted; `value` is then only the start value
};

struct PsychometricSettings {
    PsychometricShape shape;
    Rate guess, lapse;
};

struct PsychometricFit {
    PsychometricShape shape;
    PsychometricParameters parameters;
    PsychometricParameters standard_error; ///< 0 if fixed or at a bound; NaN if the data do not determine it
    Matrix covariance;                     ///< of threshold, log scale, guess, lapse
    double log_likelihood = 0;
    double deviance = 0; ///< against one free proportion per level
    int degrees_of_freedom = 0;
    double fit_p = 1; ///< P(deviance or larger) by chi-square, which is inaccurate for few trials per level
    bool converged = false;
    std::string note; ///< what the data could not determine; empty = nothing
};

/// Standard error of u where P has this proportion, by the delta method; NaN as level_at.
double standard_error_at(PsychometricFit const& fit, double proportion);

/// Whether answers get better with u within observers (Mantel 1963, JASA 58:690). Between them they may not:
/// staircases of observers who err more stay at easier levels.
class Trend {
public:
    void add(double u, double n_correct, double n);
    void next_observer();
    bool is_falling() const; ///< by more than two standard errors

private:
    struct Sums { ///< over trials of an observer, u from his or her first level
        double first = 0, trials = 0, correct = 0, u = 0, square = 0, product = 0;
    };
    Sums own_;
    double covariance_ = 0, variance_ = 0; ///< of observers before
    void finish(double& covariance, double& variance) const;
};
inline constexpr char kWrongDirection[] =
    "responses change in the wrong direction: the other end of the levels may be the harder one (see `harder`)";

/// Ignores levels without trials and merges equal levels. @throws std::invalid_argument fewer than two levels,
/// invalid counts, levels that are NaN, levels <= 0 on a logarithmic axis, rates whose sum reaches 1
PsychometricFit fit_psychometric(std::span<LevelCount const> counts, PsychometricSettings const& settings = {});

/// Converts single trials to counts, sorted by level. @throws std::invalid_argument lists of different lengths
std::vector<LevelCount> count_levels(std::span<double const> levels, std::span<int const> correct);

} // namespace study
