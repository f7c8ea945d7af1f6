#pragma once
// Latin squares as lists of rows; each row is an order of 0..n-1.

#include <vector>

namespace study {

using Square = std::vector<std::vector<int>>;

/// Row r is r, r+1, ... mod n: every item occurs once in every place.
Square latin_square(int n);
/// Williams (1949, Australian J. Scientific Research A 2:149-168). For even n (n rows) every item occurs once in
/// every place, and every ordered pair of neighbours once. For odd n (2n rows: a square and its mirror image)
/// pairs occur twice. n = 1: one row.
Square williams_square(int n);

} // namespace study
