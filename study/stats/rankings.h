#pragma once
// Plackett & Luce's model of rankings and of choices among several (Luce 1959, "Individual Choice Behavior";
// Plackett 1975, Appl. Stat. 24:193): P(i is chosen of C) = exp(s_i) / sum_{j in C} exp(s_j); a ranking is a
// choice of the best, then of the best of the rest, and so on. Of two items it is Bradley & Terry's model.

#include "study/stats/scores.h"

#include <span>
#include <string>

namespace study {

struct ChoiceAmong {
    int chosen = 0;
    std::vector<int> rejected;
};

/// The choices that make a ranking: the best among all, the next among the rest, and so on.
/// @param ranking  items, best first, not necessarily all of them
std::vector<ChoiceAmong> choices_of(std::span<int const> ranking);

struct PlackettLuce {
    std::vector<double> score; ///< natural logarithm of strength, mean 0
    std::vector<double> standard_error;
    Matrix covariance;
    double log_likelihood = 0;
    bool regularised = false;
    std::string note; ///< measures taken to get finite numbers; empty = none
};

/// Fits by maximum likelihood; if that is infinite, with Jeffreys' prior (likelihood.h), and `note` reports it.
/// @throws std::invalid_argument no items, an item out of range or twice in a choice,
/// items not connected by a chain of choices
PlackettLuce fit_plackett_luce(std::span<ChoiceAmong const> choices, int items);

} // namespace study
