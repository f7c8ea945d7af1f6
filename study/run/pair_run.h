#pragma once
// Chooses the pairs of a block from the answers so far (active sampling).

#include "study/adaptive/active_pairs.h"
#include "study/plan/plan.h"

namespace study {

/// The choice of pairs in one cell of one pass of a block with `pairs: {sampling: active}`. It depends only on the
/// script's seed, the participant and the answers.
class PairRun {
public:
    /// @param purpose  number of the random stream, unique to the cell in the participant's session
    PairRun(Script const& script, Block const& block, int participant, std::uint64_t purpose);

    /// Levels of the paired factor.
    std::pair<int, int> next() const;
    /// @param response  of a valid answer: first, second or neither; empty = there was none
    /// @param order     of presentation: "ab" or "ba"
    void shown(std::pair<int, int> levels, std::string const& order, std::string const& response);

private:
    int item_of(int level) const;

    std::vector<int> levels_; ///< by item
    ActivePairs pairs_;
};

/// "best/fair", for the journal.
std::string pair_text(Script const& script, Block const& block, std::pair<int, int> levels);
/// Inverse of pair_text; none if the text names no pair of the block.
std::optional<std::pair<int, int>> pair_of_text(Script const& script, Block const& block, std::string const& text);

} // namespace study
