#pragma once
// The trials of one block, before and after ordering.

#include "study/numeric/random.h"
#include "study/plan/plan.h"

namespace study {

/// All main trials, unordered: repeats within conditions within cells.
/// @param levels by factor, those fixed for this pass of the block; -1 = not fixed
std::vector<Trial> main_trials(Script const& script, Block const& block, std::vector<int> const& levels,
                               int participant, Random& random);
/// Levels of all factors for every cell of cross and nest.
std::vector<std::vector<int>> cells_of(Script const& script, Block const& block, std::vector<int> const& levels);
std::vector<Trial> catch_trials(Script const& script, Block const& block, std::vector<int> const& levels,
                                int count, Random& random);
/// Practice, then main trials with catch trials among them, in their final order. Throws ScriptError.
/// @param purpose  number of the random stream, unique to this pass of this block
std::vector<Trial> ordered_trials(Script const& script, Block const& block, std::vector<int> const& levels,
                                  int participant, std::uint64_t purpose);

/// Random generator for one purpose and one participant.
Random random_for(Script const& script, int participant, std::uint64_t purpose);

} // namespace study
