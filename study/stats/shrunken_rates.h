#pragma once
// Rates of several observers, such as their false alarms, of few trials each. Taken as known, rates that differ by
// chance bias what depends on them: a mean threshold of yes/no by -4 % with 60 trials of 20 observers.

#include <span>
#include <vector>

namespace study {

struct RateCount {
    double yes = 0, trials = 0;
};

/// Each observer's rate given the answers of all: rates have a beta distribution between observers, whose mean and
/// variance are those of the counts (Kleinman 1973, JASA 68:46). Rates that do not differ by more than chance are
/// their common one. All are above 0 and below 1, as half an answer is added to each kind. Observers without
/// trials get the mean. @throws std::invalid_argument nobody has trials, or more answers than trials
std::vector<double> shrunken_rates(std::span<RateCount const> observers);

} // namespace study
