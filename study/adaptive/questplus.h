#pragma once
// QUEST+ (Watson 2017, J. Vision 17(3):10): a posterior over a grid of threshold x slope x guess x lapse; the next
// stimulus is the one with the least expected entropy. QUEST (Watson & Pelli 1983) is the case of one
// slope, guess and lapse, Psi (Kontsevich & Tyler 1999) that of one guess and lapse.
//   P(x) = guess + (1 - guess - lapse) F(x),  F one of QuestFunction.

#include "study/adaptive/psychometric_curve.h"
#include "study/numeric/matrix.h"

namespace study {

enum class QuestFunction {
    weibull_db,        ///< 1 - exp(-10^(slope (x - threshold) / 20)): x and threshold in dB, as in Watson's paper
    weibull,           ///< 1 - exp(-(x / threshold)^slope): x and threshold > 0
    gaussian,          ///< Phi((x - threshold) / slope): the slope is a standard deviation
    logistic,          ///< 1 / (1 + exp(-slope (x - threshold)))
    gumbel,            ///< 1 - exp(-exp((x - threshold) / slope))
    gumbel_right,      ///< exp(-exp(-(x - threshold) / slope))
    hyperbolic_secant, ///< 2/pi atan(exp(pi/2 (x - threshold) / slope))
    cauchy,            ///< 1/2 + atan((x - threshold) / slope) / pi
    formula            ///< P itself by QuestSettings::formula; the direction is not used
};

struct QuestParameters {
    double threshold = 0, slope = 1, guess = 0, lapse = 0;
};

struct QuestSettings {
    QuestFunction function = QuestFunction::weibull_db;
    /// Falling: larger x are harder, F(threshold - x) and (threshold / x)
    Direction direction = Direction::rising;
    std::vector<double> stimuli;
    std::vector<double> threshold, slope, guess{0.5}, lapse{0.02};
    /// Prior weights of the values above, not necessarily normalised; empty = uniform.
    std::vector<double> threshold_prior, slope_prior, guess_prior, lapse_prior;
    /// Stimuli whose expected entropies differ by less (bits) are tied, and the first one is shown. Without it the
    /// choice would depend on rounding, which differs between machines.
    double tie_tolerance = 1e-10;
    std::shared_ptr<Formula const> formula{}; ///< P of x, threshold, slope, guess, lapse
};

class QuestPlus {
public:
    /// @throws std::invalid_argument an empty vector, NaN, slopes <= 0, stimuli or thresholds <= 0 for
    /// QuestFunction::weibull, rates outside [0, 1) or whose sums reach 1, priors of other lengths, negative or
    /// all zero, a formula whose value is no proportion
    explicit QuestPlus(QuestSettings settings);

    /// Index into settings().stimuli of the next stimulus.
    std::size_t next() const;
    /// @param stimulus  index into settings().stimuli
    /// @throws std::invalid_argument no such stimulus, or a response that all remaining parameters exclude
    void respond(std::size_t stimulus, bool correct);

    /// By how much a response to this stimulus is expected to lower the entropy, bits.
    double expected_information(std::size_t stimulus) const;
    double entropy() const; ///< of the posterior, bits

    QuestParameters mode() const; ///< the most probable cell; the first of ties
    QuestParameters mean() const;
    QuestParameters standard_deviation() const;
    std::vector<double> const& posterior() const { return posterior_; } ///< of all cells; sum 1
    QuestParameters parameters(std::size_t cell) const;
    QuestSettings const& settings() const { return settings_; }

private:
    template <class Value>
    QuestParameters expectation(Value const& value) const;

    QuestSettings settings_;
    std::vector<double> posterior_; ///< lapse fastest, threshold slowest
    Matrix correct_;                ///< stimuli x cells: P(correct)
    Matrix noise_;                  ///< stimuli x cells: entropy of the response itself, bits
};

/// P(correct) of one stimulus, with the function or formula of the settings.
double proportion_by(QuestSettings const& settings, QuestParameters const& p, double stimulus);
/// P(correct) of one stimulus; not for QuestFunction::formula.
double proportion_at(QuestFunction function, Direction direction, QuestParameters const& p, double stimulus);

} // namespace study
