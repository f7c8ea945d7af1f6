#include "study/stats/pairs.h"

#include "study/numeric/error.h"

#include <cmath>
#include <map>
#include <utility>

namespace study {
namespace {

/// Nodes reachable from `start` along edges(from, to) > 0, or against them.
std::vector<bool> reached(Matrix const& edges, std::size_t start, bool const along, bool const against)
{
    std::vector<bool> seen(edges.rows, false);
    std::vector<std::size_t> open{start};
    seen[start] = true;
    while (!open.empty()) {
        std::size_t const at = open.back();
        open.pop_back();
        for (std::size_t to = 0; to < edges.rows; ++to) {
            bool const edge = (along && edges(at, to) > 0) || (against && edges(to, at) > 0);
            if (!edge || seen[to]) continue;
            seen[to] = true;
            open.push_back(to);
        }
    }
    return seen;
}

bool all(std::vector<bool> const& flags)
{
    for (bool const f : flags)
        if (!f) return false;
    return true;
}

} // namespace

void check_pairs(std::span<PairCount const> pairs, int items)
{
    if (items < 1) refuse("paired comparisons of no items", "there is nothing to scale", "give one item or more");
    for (PairCount const& p : pairs) {
        std::string const name = "pair " + std::to_string(p.first) + ", " + std::to_string(p.second);
        if (p.first < 0 || p.second < 0 || p.first >= items || p.second >= items)
            refuse(name, "items are numbered from 0 to " + std::to_string(items - 1), "check the item numbers");
        if (p.first == p.second)
            refuse(name, "an item was compared with itself", "leave such trials out: they say nothing of scores");
        for (double const count : {p.first_wins, p.second_wins, p.ties})
            if (!(count >= 0 && std::isfinite(count)))
                refuse("count " + std::to_string(count) + " of " + name, "counts are numbers from 0 up",
                       "check the table");
    }
}

std::vector<PairCount> pairs_of(Matrix const& wins)
{
    if (wins.rows != wins.columns)
        refuse("a table of " + std::to_string(wins.rows) + " x " + std::to_string(wins.columns),
               "wins(i, j) needs as many rows as columns", "give one row and one column per item");
    std::vector<PairCount> pairs;
    for (std::size_t i = 0; i < wins.rows; ++i)
        for (std::size_t j = i + 1; j < wins.rows; ++j)
            if (wins(i, j) != 0 || wins(j, i) != 0) pairs.push_back({int(i), int(j), wins(i, j), wins(j, i), 0});
    check_pairs(pairs, int(wins.rows));
    return pairs;
}

std::vector<PairCount> without_order(std::span<PairCount const> pairs)
{
    std::map<std::pair<int, int>, PairCount> sums;
    for (PairCount p : pairs) {
        if (p.first > p.second) {
            std::swap(p.first, p.second);
            std::swap(p.first_wins, p.second_wins);
        }
        PairCount& sum = sums[{p.first, p.second}];
        sum = {p.first, p.second, sum.first_wins + p.first_wins, sum.second_wins + p.second_wins,
               sum.ties + p.ties};
    }
    std::vector<PairCount> out;
    for (auto const& [unused, sum] : sums) out.push_back(sum);
    return out;
}

Matrix wins_of(std::span<PairCount const> pairs, int items)
{
    check_pairs(pairs, items);
    auto const n = std::size_t(items);
    Matrix wins(n, n);
    for (PairCount const& p : pairs) {
        auto const i = std::size_t(p.first), j = std::size_t(p.second);
        wins(i, j) += p.first_wins + p.ties / 2;
        wins(j, i) += p.second_wins + p.ties / 2;
    }
    return wins;
}

std::vector<int> connected_parts(Matrix const& edges)
{
    std::vector<int> part(edges.rows, -1);
    int parts = 0;
    for (std::size_t i = 0; i < edges.rows; ++i) {
        if (part[i] >= 0) continue;
        std::vector<bool> const seen = reached(edges, i, true, true);
        for (std::size_t j = 0; j < edges.rows; ++j)
            if (seen[j]) part[j] = parts;
        ++parts;
    }
    return part;
}

bool each_beats_each(Matrix const& wins)
{
    return wins.rows < 2 || (all(reached(wins, 0, true, false)) && all(reached(wins, 0, false, true)));
}

} // namespace study
