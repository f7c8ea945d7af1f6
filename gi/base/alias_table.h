#pragma once
// Walker/Vose alias tables: draw from n weights in constant time.

#include "gi/base/math.h"
#include "gi/base/view.h"

#include <vector>

namespace gi {

struct AliasEntry {
    float keep;          ///< probability of staying in this bin
    std::uint32_t alias; ///< where to go otherwise
    float probability;   ///< of drawing this index
};

struct AliasTableView {
    View<AliasEntry const> entries;

    /// Draw an index from u in [0, 1); u is remapped to a fresh uniform number in [0, 1).
    GI_FN std::uint32_t sample(float& u) const
    {
        float const scaled = u * float(entries.size());
        auto i = std::uint32_t(scaled);
        if (i >= entries.size()) i = std::uint32_t(entries.size()) - 1;
        float const within = glm::min(scaled - float(i), 0x1.fffffep-1f);
        AliasEntry const& e = entries[i];
        if (within < e.keep) {
            u = glm::min(within / e.keep, 0x1.fffffep-1f);
            return i;
        }
        u = glm::min((within - e.keep) / (1.0f - e.keep), 0x1.fffffep-1f);
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

/// Weights that are negative or not finite count as zero; if all are zero the table is empty.
AliasTable make_alias_table(View<float const> weights);

} // namespace gi
