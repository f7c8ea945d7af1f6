#include "study/plan/arrange.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

constexpr int kDraws = 200;             ///< number of whole orders drawn first
constexpr int kSearches = 10;           ///< restarts of the search
constexpr long kStepsPerSearch = 10000; ///< in addition to those of a search without backtracking

bool has(std::vector<int> const& tokens, int token)
{
    return std::find(tokens.begin(), tokens.end(), token) != tokens.end();
}

/// True if `rule` allows the item at `place` after the previous ones.
bool allows(ArrangeRule const& rule, std::size_t r, std::span<ArrangeItem const> items, std::span<int const> order,
            std::size_t place)
{
    auto const tokens = [&](std::size_t p) -> std::vector<int> const& {
        return items[std::size_t(order[p])].tokens[r];
    };
    if (rule.kind == RuleKind::not_first) return place > 0 || !has(tokens(0), rule.to);
    if (rule.kind == RuleKind::never_after)
        return place == 0 || !has(tokens(place), rule.to) || !has(tokens(place - 1), rule.from);
    for (int const token : tokens(place)) {
        if (rule.kind == RuleKind::max_run) {
            std::size_t run = 1;
            while (run <= std::size_t(rule.count) && run <= place && has(tokens(place - run), token)) ++run;
            if (run > std::size_t(rule.count)) return false;
        } else {
            for (std::size_t back = 1; back <= std::size_t(rule.count) && back <= place; ++back)
                if (has(tokens(place - back), token)) return false;
        }
    }
    return true;
}

/// Depth-first search over kinds of items: items with the same tokens and group are of one kind.
class Search {
public:
    Search(std::span<ArrangeItem const> items, std::span<ArrangeRule const> rules, std::span<int const> groups)
        : items_(items), rules_(rules), groups_(groups)
    {
        std::map<std::pair<int, std::vector<std::vector<int>>>, std::size_t> kinds;
        for (std::size_t i = 0; i < items.size(); ++i) {
            auto const [at, is_new] = kinds.emplace(std::pair{items[i].group, items[i].tokens}, kinds.size());
            if (is_new) members_.emplace_back();
            members_[at->second].push_back(int(i));
        }
        for (std::size_t r = 0; r < rules.size(); ++r) {
            tokens_.emplace_back();
            for (ArrangeItem const& item : items)
                for (int const t : item.tokens[r]) ++tokens_.back()[t];
        }
    }

    enum class Result { found, none, gave_up };
    Result run(Random& random)
    {
        left_ = tokens_;
        used_.assign(members_.size(), 0);
        order_.clear();
        steps_ = kStepsPerSearch + long(items_.size());
        return descend(random);
    }
    std::vector<int> const& order() const { return order_; }

private:
    Result descend(Random& random)
    {
        if (order_.size() == items_.size()) return Result::found;
        if (--steps_ < 0) return Result::gave_up;
        std::vector<int> kinds = candidates();
        while (!kinds.empty()) {
            std::size_t const k = draw_kind(kinds, random);
            place(k);
            bool const may_be = is_allowed() && has_room();
            Result const result = may_be ? descend(random) : Result::none;
            if (result != Result::none) return result;
            take_back(k);
        }
        return Result::none;
    }

    std::uint32_t left(int kind) const
    {
        return std::uint32_t(members_[std::size_t(kind)].size() - used_[std::size_t(kind)]);
    }
    /// Remaining kinds of the next place's group.
    std::vector<int> candidates() const
    {
        std::vector<int> kinds;
        for (int k = 0; k < int(members_.size()); ++k)
            if (left(k) > 0 && items_[std::size_t(members_[std::size_t(k)][0])].group == groups_[order_.size()])
                kinds.push_back(k);
        return kinds;
    }
    /// Removes and returns a random kind, weighted by its remaining members.
    std::size_t draw_kind(std::vector<int>& kinds, Random& random) const
    {
        std::uint32_t total = 0;
        for (int const k : kinds) total += left(k);
        std::uint32_t r = random.below(total);
        std::size_t i = 0;
        while (r >= left(kinds[i])) r -= left(kinds[i++]);
        int const kind = kinds[i];
        kinds[i] = kinds.back();
        kinds.pop_back();
        return std::size_t(kind);
    }

    void place(std::size_t kind)
    {
        order_.push_back(members_[kind][used_[kind]++]);
        for (std::size_t r = 0; r < rules_.size(); ++r)
            for (int const t : items_[std::size_t(order_.back())].tokens[r]) --left_[r][t];
    }
    void take_back(std::size_t kind)
    {
        for (std::size_t r = 0; r < rules_.size(); ++r)
            for (int const t : items_[std::size_t(order_.back())].tokens[r]) ++left_[r][t];
        order_.pop_back();
        --used_[kind];
    }

    bool is_allowed() const
    {
        for (std::size_t r = 0; r < rules_.size(); ++r)
            if (!allows(rules_[r], r, items_, order_, order_.size() - 1)) return false;
        return true;
    }

    /// True if the remaining trials of each token can still be separated; a necessary condition.
    bool has_room() const
    {
        std::size_t const open = items_.size() - order_.size();
        for (std::size_t r = 0; r < rules_.size(); ++r) {
            std::size_t const count = std::size_t(rules_[r].count);
            if (rules_[r].kind != RuleKind::max_run && rules_[r].kind != RuleKind::min_gap) continue;
            for (auto const& [token, left] : left_[r]) {
                std::size_t const n = std::size_t(left);
                if (n == 0) continue;
                std::size_t since = 0; // places since the last occurrence of the token, at most count
                while (since < count && since < order_.size() && !has(token_at(r, since), token)) ++since;
                if (rules_[r].kind == RuleKind::max_run) {
                    std::size_t run = 0;
                    while (run < order_.size() && run < count && has(token_at(r, run), token)) ++run;
                    if (n > (count - run) + count * (open - n)) return false;
                } else {
                    std::size_t const wait = since < order_.size() ? count - since : 0;
                    if (wait + (n - 1) * (count + 1) + 1 > open) return false;
                }
            }
        }
        return true;
    }
    std::vector<int> const& token_at(std::size_t rule, std::size_t back) const
    {
        return items_[std::size_t(order_[order_.size() - 1 - back])].tokens[rule];
    }

    std::span<ArrangeItem const> items_;
    std::span<ArrangeRule const> rules_;
    std::span<int const> groups_;
    std::vector<std::vector<int>> members_; ///< by kind
    std::vector<std::map<int, int>> tokens_, left_;
    std::vector<std::size_t> used_;
    std::vector<int> order_;
    long steps_ = 0;
};

/// Shuffles each group's items over the places of the group.
std::vector<int> draw(std::span<ArrangeItem const> items, std::span<int const> groups, Random& random)
{
    std::map<int, std::vector<int>> by_group;
    for (std::size_t i = 0; i < items.size(); ++i) by_group[items[i].group].push_back(int(i));
    for (auto& [unused, members] : by_group) random.shuffle(members);
    std::vector<int> order;
    for (int const g : groups) {
        order.push_back(by_group[g].back());
        by_group[g].pop_back();
    }
    return order;
}

} // namespace

std::optional<BrokenRule> find_broken(std::span<ArrangeItem const> items, std::span<ArrangeRule const> rules,
                                      std::span<int const> order)
{
    for (std::size_t place = 0; place < order.size(); ++place)
        for (std::size_t r = 0; r < rules.size(); ++r)
            if (!allows(rules[r], r, items, order, place)) return BrokenRule{r, place};
    return {};
}

std::vector<int> arrange(std::span<ArrangeItem const> items, std::span<ArrangeRule const> rules,
                         std::span<int const> groups, Random& random)
{
    for (int i = 0; i < (rules.empty() ? 1 : kDraws); ++i) {
        std::vector<int> order = draw(items, groups, random);
        if (!find_broken(items, rules, order)) return order;
    }
    Search search(items, rules, groups);
    for (int i = 0; i < kSearches; ++i) {
        Search::Result const result = search.run(random);
        if (result == Search::Result::found) return search.order();
        if (result == Search::Result::none)
            throw NoOrder(fmt::format("no order of these {} trials satisfies the rules", items.size()));
    }
    throw NoOrder(fmt::format("no order of these {} trials that satisfies the rules was found in {} searches",
                              items.size(), kSearches));
}

} // namespace study
