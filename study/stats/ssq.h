#pragma once
// The Simulator Sickness Questionnaire (Kennedy, Lane, Berbaum & Lilienthal 1993, Int. J. Aviat. Psychol. 3:203):
// 16 symptoms from 0 (none) to 3 (severe); three overlapping sums of seven, each with its weight, and a total.

#include <span>

namespace study {

struct SimulatorSickness {
    double nausea = 0;         ///< 9.54 x the sum of items 1, 6, 7, 8, 9, 15, 16
    double oculomotor = 0;     ///< 7.58 x 1, 2, 3, 4, 5, 9, 11
    double disorientation = 0; ///< 13.92 x 5, 8, 10, 11, 12, 13, 14
    double total = 0;          ///< 3.74 x the three sums
};

/// @param symptoms  in the order of the questionnaire. @throws std::invalid_argument other than 16, or one that is
/// not between 0 and 3
SimulatorSickness simulator_sickness(std::span<double const> symptoms);

} // namespace study
