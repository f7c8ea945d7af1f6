#pragma once
// Counterbalancing: which order, or which level, a participant gets.
//
// Participants are numbered from 1. The orders of a script are the digits of (number - 1) in
// a mixed-radix system, the first one of the script varying fastest, so that they are fully crossed:
// with `alternate` for displays and `williams` for three blocks, participants 1 to 12 get every combination
// of 2 display orders and 6 block orders once.

#include "study/numeric/random.h"
#include "study/script/script.h"

namespace study {

/// Number of levels or blocks that a counterbalance orders.
int item_count(Script const& script, Counterbalance const& balance);
/// Number of participants after which the orders repeat; random and fixed: 1.
int cycle_length(Balance method, int items);
/// Number of participants after which every combination of orders has occurred equally often.
std::int64_t full_cycle(Script const& script);
/// The digit of each counterbalance of the script for this participant.
std::vector<int> digits(Script const& script, int participant);
/// An order of 0..items-1; between: only the participant's level. @param random is used only by Balance::random
std::vector<int> balanced_order(Balance method, int items, int digit, Random& random);

} // namespace study
