#pragma once
// QUEST+ of several stimulus dimensions and any parameters (Watson 2017, J. Vision 17(3):10): the posterior over
// the grid of all parameters, P(correct) a formula of stimulus and parameters, such as a contrast sensitivity
// function of contrast and spatial frequency. The next stimulus is the point of the stimulus grid with the least
// expected entropy. For one dimension and the usual four parameters questplus.h is the same with less work.

#include "study/adaptive/formula.h"
#include "study/numeric/matrix.h"

#include <memory>
#include <optional>
#include <span>

namespace study {

/// A dimension of the stimulus or a parameter: its name in the formula and its values.
struct QuestGrid {
    std::string name;
    std::vector<double> values;
    std::vector<double> prior{}; ///< weights of parameter values, not necessarily normalised; empty = uniform
};

struct QuestManySettings {
    std::vector<QuestGrid> stimulus, parameters;
    /// Of values with these names: those of stimulus, then those of parameters.
    std::shared_ptr<Formula const> formula;
    double tie_tolerance = 1e-10; ///< bits; see QuestSettings
};

/// The names that a formula of these dimensions and parameters takes, in its order.
std::vector<std::string> names_of(std::vector<QuestGrid> const& stimulus,
                                  std::vector<QuestGrid> const& parameters);

class QuestPlusMany {
public:
    /// @throws std::invalid_argument an empty grid, a value that is not finite, a prior of another length, more
    /// than 2e7 pairs of stimulus and parameters, or a formula that is not between 0 and 1 everywhere
    explicit QuestPlusMany(QuestManySettings settings);

    /// Index of the next stimulus on the grid; the first dimension varies slowest.
    std::size_t next() const;
    std::vector<double> stimulus(std::size_t index) const;
    /// The index of a stimulus on the grid, whose values differ by at most 1e-6 of their size;
    /// none = it is not on it.
    std::optional<std::size_t> index_of(std::span<double const> stimulus) const;
    /// @throws std::invalid_argument a response that all remaining parameters exclude
    void respond(std::size_t stimulus, bool correct);

    double entropy() const;                                                     ///< of the posterior, bits
    std::vector<double> mode() const, mean() const, standard_deviation() const; ///< by parameter
    std::vector<double> marginal(std::size_t parameter) const;                  ///< posterior of its values
    std::size_t stimuli() const { return stimuli_; }

private:
    std::vector<double> point(std::vector<QuestGrid> const& grids, std::size_t index) const;
    double information(std::size_t stimulus) const;

    QuestManySettings settings_;
    std::size_t stimuli_ = 1, cells_ = 1;
    std::vector<double> posterior_; ///< the last parameter fastest
    Matrix correct_;                ///< stimuli x cells: P(correct)
    Matrix noise_;                  ///< its entropy, bits
};

} // namespace study
