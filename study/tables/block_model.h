#pragma once
// What a mixed model of a block's trials needs, for the scripts analysis.R and analysis.py.

#include "study/script/script.h"

#include <string>
#include <vector>

namespace study {

enum class ModelKind {
    pairs,     ///< which of two items was chosen
    values,    ///< a rating, magnitude or adjusted level
    detection, ///< whether the answer was correct
    yes_no,    ///< "yes" with and without a signal
};

struct BlockModel {
    std::string block, task;
    ModelKind kind = ModelKind::values;
    /// Columns of factors that vary in the block, between participants too, except the one that it compares.
    std::vector<std::string> factors;
    std::vector<std::string> between; ///< those of them that differ between participants
    std::vector<std::string> items;   ///< of pairs: the levels
    bool compares_factor = false;     ///< the column cond_a has the compared levels
    bool compares_pairs = false;      ///< and cond_b those with which they are compared
    bool has_level = false;           ///< the column level has the varied setting
    bool is_log = false;              ///< of values or levels
    double guess = 0;                 ///< proportion of correct answers by guessing
};

/// A model for each block with trials that have one: not rankings, questionnaires and walks.
std::vector<BlockModel> block_models(Script const& script);

/// Quotes a text for R and for Python: backslash, quotes; control characters become spaces.
std::string quoted(std::string const& text);

} // namespace study
