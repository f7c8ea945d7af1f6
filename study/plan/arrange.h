#pragma once
// Random orders of trials that satisfy all rules, or an error if none is found.

#include "study/numeric/random.h"
#include "study/script/script.h"

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace study {

/// Properties of a trial that rules use.
struct ArrangeItem {
    /// By rule: the trial's values of the rule's subject; empty = the rule ignores the trial.
    std::vector<std::vector<int>> tokens;
    int group = 0; ///< each place of the order belongs to a group and takes only items of this group
};

/// max_run: the same token in at most `count` trials in a row. min_gap: at least `count` trials between two with
/// the same token. never_after: no token `to` directly after `from`. not_first: no token `to` in the first trial.
struct ArrangeRule {
    RuleKind kind = RuleKind::max_run;
    int count = 1, from = -1, to = -1;
};

/// No order exists, or none was found within the step limit; what() states which and why.
class NoOrder : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The first place at which a rule is broken.
struct BrokenRule {
    std::size_t rule = 0, place = 0;
};
std::optional<BrokenRule> find_broken(std::span<ArrangeItem const> items, std::span<ArrangeRule const> rules,
                                      std::span<int const> order);

/// Returns indices of items, place by place. @param groups of the places; there are as many places of each group
/// as items. First, whole orders are drawn until one satisfies the rules; all valid orders are then equally
/// likely. If valid orders are too rare, a depth-first search with look-ahead places one trial after the other,
/// chosen at random in proportion to the number of remaining trials of its kind. Throws NoOrder if the search
/// proves that no order exists, or gives up.
std::vector<int> arrange(std::span<ArrangeItem const> items, std::span<ArrangeRule const> rules,
                         std::span<int const> groups, Random& random);

} // namespace study
