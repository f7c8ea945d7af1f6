#include "study/stats/triads.h"

#include "study/numeric/error.h"

#include <string>

namespace study {
namespace {

std::string pair_name(std::size_t i, std::size_t j)
{
    return "pair " + std::to_string(i) + ", " + std::to_string(j);
}

void check_square(Matrix const& table)
{
    if (table.rows != table.columns || table.rows == 0)
        refuse("a table of " + std::to_string(table.rows) + " x " + std::to_string(table.columns),
               "choices need one row and one column per item", "give a square table");
}

} // namespace

CircularTriads circular_triads(Matrix const& prefers)
{
    check_square(prefers);
    int const n = int(prefers.rows);
    std::vector<int> wins(prefers.rows, 0);
    for (std::size_t i = 0; i < prefers.rows; ++i)
        for (std::size_t j = 0; j < prefers.rows; ++j) {
            double const a = prefers(i, j), b = prefers(j, i);
            if (i != j && !((a == 1 && b == 0) || (a == 0 && b == 1)))
                refuse(pair_name(i, j), "circular triads need one choice for each pair",
                       "leave this observer out");
            if (i != j) wins[i] += int(a);
        }
    int count = n * (n - 1) * (n - 2) / 6;
    for (int const s : wins) count -= s * (s - 1) / 2;
    return {count, (n * n * n - (n % 2 ? 1 : 4) * n) / 24};
}

} // namespace study
