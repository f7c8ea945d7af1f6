#include "study/stats/triads.h"

#include "study/stats/error.h"
#include "study/stats/special.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace study {
namespace {

int choose3(int n) { return n * (n - 1) * (n - 2) / 6; }

int triads_of(std::vector<int> const& wins)
{
    int sum = choose3(int(wins.size()));
    for (int const s : wins) sum -= s * (s - 1) / 2;
    return sum;
}

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

std::vector<std::uint64_t> circular_triad_counts(int n)
{
    if (n < 1 || n > kExactTriadItems)
        refuse("the distribution of circular triads of " + std::to_string(n) + " items",
               "it is known here for 1 to " + std::to_string(kExactTriadItems),
               "use the chi-square approximation");
    // Tournaments by sorted wins: a new item plays against each existing one.
    std::map<std::vector<int>, std::uint64_t> counts{{{0}, 1}};
    for (int k = 1; k < n; ++k) {
        std::map<std::vector<int>, std::uint64_t> grown;
        for (auto const& [wins, count] : counts)
            for (unsigned lost = 0; lost < (1u << k); ++lost) { // bits: the items to which the new one lost
                std::vector<int> next = wins;
                int own = 0;
                for (int i = 0; i < k; ++i) (lost >> i & 1u) ? ++next[std::size_t(i)] : ++own;
                next.push_back(own);
                std::sort(next.begin(), next.end());
                grown[next] += count;
            }
        counts = std::move(grown);
    }
    std::vector<std::uint64_t> by_triads;
    for (auto const& [wins, count] : counts) {
        auto const t = std::size_t(triads_of(wins));
        if (by_triads.size() <= t) by_triads.resize(t + 1);
        by_triads[t] += count;
    }
    return by_triads;
}

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
    CircularTriads r;
    r.count = triads_of(wins);
    r.maximum = (n * n * n - (n % 2 ? 1 : 4) * n) / 24;
    r.expected = choose3(n) / 4.0;
    r.zeta = r.maximum > 0 ? 1 - double(r.count) / r.maximum : std::nan("");
    r.chi_square = r.degrees_of_freedom = std::nan("");
    if (n > 4) {
        r.degrees_of_freedom = double(n) * (n - 1) * (n - 2) / ((n - 4.0) * (n - 4.0));
        r.chi_square = 8.0 / (n - 4) * (r.expected - r.count - 0.5) + r.degrees_of_freedom;
    }
    if (n > kExactTriadItems) {
        r.p = chi_square_tail(r.chi_square, r.degrees_of_freedom);
        return r;
    }
    double fewer = 0, all = 0;
    std::vector<std::uint64_t> const counts = circular_triad_counts(n);
    for (std::size_t t = 0; t < counts.size(); ++t) {
        all += double(counts[t]);
        if (int(t) <= r.count) fewer += double(counts[t]);
    }
    r.p = fewer / all;
    return r;
}

} // namespace study
