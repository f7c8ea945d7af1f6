#pragma once
// Paired comparisons as counts, and what can be said of their design.

#include "study/stats/matrix.h"

#include <string>

namespace study {

/// How often two items met with `first` shown first (or left), and what was chosen. Counts need not be whole.
struct PairCount {
    int first = 0, second = 0; ///< items, from 0
    double first_wins = 0, second_wins = 0, ties = 0;
};

/// One count per pair i < j that met, with i as first: for data whose order was not kept.
/// @param wins  n x n; wins(i, j) = how often i was chosen over j. @throws std::invalid_argument as check_pairs
std::vector<PairCount> pairs_of(Matrix const& wins);
/// n x n, ties as half a win for each.
Matrix wins_of(std::span<PairCount const> pairs, int items);

/// @throws std::invalid_argument no items, an item out of range or compared with itself, a count that is negative
/// or no number
void check_pairs(std::span<PairCount const> pairs, int items);

/// The part of the graph of comparisons that each item is in, numbered from 0. Scores of items in different parts
/// cannot be compared. @param edges  n x n, > 0 = compared (either way)
std::vector<int> connected_parts(Matrix const& edges);
/// Whether each item won, over some chain of others, against each other one: the condition for finite scores by
/// maximum likelihood (Ford 1957, Amer. Math. Monthly 64(8-2):28).
bool each_beats_each(Matrix const& wins);

} // namespace study
