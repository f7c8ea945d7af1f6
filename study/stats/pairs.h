#pragma once
// Paired comparisons as counts, and properties of their design.

#include "study/numeric/matrix.h"

#include <span>
#include <string>

namespace study {

/// Choices between two items with `first` shown first (or left). Counts need not be integers.
struct PairCount {
    int first = 0, second = 0; ///< items, from 0
    double first_wins = 0, second_wins = 0, ties = 0;
};

/// One count per compared pair i < j, with i as first: for data without presentation order.
/// @param wins  n x n; wins(i, j) = how often i was chosen over j. @throws std::invalid_argument as check_pairs
std::vector<PairCount> pairs_of(Matrix const& wins);
/// The same choices with the smaller item as first, one count per pair: for models without an order effect.
std::vector<PairCount> without_order(std::span<PairCount const> pairs);
/// n x n, ties as half a win for each.
Matrix wins_of(std::span<PairCount const> pairs, int items);

/// @throws std::invalid_argument no items, an item out of range or compared with itself,
/// a count that is negative or NaN
void check_pairs(std::span<PairCount const> pairs, int items);

/// Connected component of the graph of comparisons for each item, numbered from 0. Scores of items in different
/// components cannot be compared. @param edges  n x n, > 0 = compared (in either direction)
std::vector<int> connected_parts(Matrix const& edges);
/// True if each item beats each other item through a chain of wins: the condition for finite scores by maximum
/// likelihood (Ford 1957, Amer. Math. Monthly 64(8-2):28).
bool each_beats_each(Matrix const& wins);

} // namespace study
