#include "study/run/pair_run.h"

#include "study/plan/block_trials.h"

#include <algorithm>

namespace study {
namespace {

std::vector<ActivePairs::Pair> items_of_pairs(Pairs const& pairs, std::vector<int> const& levels)
{
    auto const item = [&](int level) {
        return int(std::lower_bound(levels.begin(), levels.end(), level) - levels.begin());
    };
    std::vector<ActivePairs::Pair> items;
    for (auto const& [a, b] : pairs.pairs) items.emplace_back(item(a), item(b));
    return items;
}

ActiveSettings active_settings(Script const& s, Pairs const& pairs, int participant, std::uint64_t purpose)
{
    ActiveSettings settings;
    settings.is_tree = pairs.is_tree;
    Random random = random_for(s, participant, purpose);
    std::uint64_t const high = random.next();
    settings.seed = (high << 32) | random.next();
    return settings;
}

} // namespace

PairRun::PairRun(Script const& script, Block const& block, int participant, std::uint64_t purpose)
    : levels_(levels_of_pairs(*block.pairs)),
      pairs_(int(levels_.size()), items_of_pairs(*block.pairs, levels_),
             active_settings(script, *block.pairs, participant, purpose))
{
}

int PairRun::item_of(int level) const
{
    return int(std::lower_bound(levels_.begin(), levels_.end(), level) - levels_.begin());
}

std::pair<int, int> PairRun::next() const
{
    auto const [a, b] = pairs_.next();
    return {levels_[std::size_t(a)], levels_[std::size_t(b)]};
}

void PairRun::shown(std::pair<int, int> levels, std::string const& order, std::string const& response)
{
    std::optional<double> wins; // of the letter a
    if (response == "neither") wins = 0.5;
    if (response == "first") wins = order.starts_with('a') ? 1 : 0;
    if (response == "second") wins = order.starts_with('a') ? 0 : 1;
    pairs_.shown({item_of(levels.first), item_of(levels.second)}, wins);
}

std::string pair_text(Script const& s, Block const& b, std::pair<int, int> levels)
{
    auto const& all = s.factors[std::size_t(b.pairs->factor)].levels;
    return all[std::size_t(levels.first)].name + "/" + all[std::size_t(levels.second)].name;
}

std::optional<std::pair<int, int>> pair_of_text(Script const& s, Block const& b, std::string const& text)
{
    for (auto const& pair : b.pairs->pairs)
        if (pair_text(s, b, pair) == text) return pair;
    return {};
}

} // namespace study
