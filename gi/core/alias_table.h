#pragma once
// Walker/Vose alias tables: draw from n weights in constant time.

#include "gi/core/math.h"
#include "gi/core/view.h"

#include <vector>

namespace gi {

struct AliasEntry {
    float keep;          ///< probability of staying in this bin
    std::uint32_t alias; ///< index drawn otherwise
    float probability;   ///< total probability of drawing this index
};

struct AliasTableView {
    View<AliasEntry const> entries;

    /// Draws an index from u in [0, 1) and remaps u to a fresh uniform number in [0, 1). u is a double because the
    /// choice among millions of bins alone uses up the 24 bits of a float.
    GI_FN std::uint32_t sample(double& u) const
    {
        constexpr double kBelowOne = 1 - 0x1p-53;
        double const scaled = u * double(entries.size());
        auto i = std::uint32_t(scaled);
        if (i >= entries.size()) i = std::uint32_t(entries.size()) - 1;
        double const within = scaled - double(i);
        AliasEntry const& e = entries[i];
        double const keep = double(e.keep);
        if (within < keep) {
            u = glm::min(within / keep, kBelowOne);
            return i;
        }
        u = glm::clamp((within - keep) / (1 - keep), 0.0, kBelowOne);
        return e.alias;
    }
    GI_FN float probability(std::uint32_t i) const { return entries[i].probability; }
    GI_FN bool empty() const { return entries.empty(); }
};

struct AliasTable {
    std::vector<AliasEntry> entries;
    double total = 0; ///< sum of the weights
    bool empty() const { return entries.empty(); }
};

inline AliasTableView view(AliasTable const& t) { return {t.entries}; }

/// Negative and non-finite weights count as zero; if all weights are zero, the table is empty.
AliasTable make_alias_table(View<float const> weights);

} // namespace gi
