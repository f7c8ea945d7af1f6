#pragma once
// Orders of trials that keep rules, by chance: exactly, or not at all.

#include "study/script/script.h"
#include "study/stats/random.h"

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace study {

/// What rules see of a trial.
struct ArrangeItem {
    std::vector<std::vector<int>>
        tokens;    ///< by rule: what it has of the rule's subject; none = the rule ignores it
    int group = 0; ///< places are of a group each, and take items of theirs only
};

/// max_run: the same token in at most `count` trials in a row. min_gap: at least `count` trials between two with
/// the same token. never_after: no token `to` directly after `from`. not_first: no token `to` in the first trial.
struct ArrangeRule {
    RuleKind kind = RuleKind::max_run;
    int count = 1, from = -1, to = -1;
};

/// There is no order, or none was found in the steps allowed; what() says which and why.
class NoOrder : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The first place at which a rule is broken; none = all are kept.
struct BrokenRule {
    std::size_t rule = 0, place = 0;
};
std::optional<BrokenRule> find_broken(std::span<ArrangeItem const> items, std::span<ArrangeRule const> rules,
                                      std::span<int const> order);

/// Indices of items, place by place. @param groups of the places, as many as there are items, with as many places
/// of each group as items. First whole orders are drawn until one keeps the rules: every order that does is
/// equally likely. Where they are too rare for that, a depth-first search with look-ahead places one trial after
/// the other, chosen by chance in proportion to how many of its kind remain. Throws NoOrder where the search has
/// shown that there is none or has given up.
std::vector<int> arrange(std::span<ArrangeItem const> items, std::span<ArrangeRule const> rules,
                         std::span<int const> groups, Random& random);

} // namespace study
