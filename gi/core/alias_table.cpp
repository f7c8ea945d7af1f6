#include "gi/core/alias_table.h"

#include "gi/core/huge_pages.h"

namespace gi {

AliasTable make_alias_table(View<float const> weights)
{
    auto const weight = [&](std::size_t i) {
        float const w = weights[i];
        return std::isfinite(w) && w > 0 ? double(w) : 0.0;
    };
    AliasTable table;
    for (std::size_t i = 0; i < weights.size(); ++i) table.total += weight(i);
    if (!(table.total > 0)) return table;

    std::size_t const n = weights.size();
    resize_on_huge_pages(table.entries, n);
    std::vector<double> scaled(n);
    std::vector<std::uint32_t> small, large;
    for (std::size_t i = 0; i < n; ++i) {
        double const p = weight(i) / table.total;
        scaled[i] = p * double(n);
        table.entries[i] = {1.0f, std::uint32_t(i), float(p)};
        (scaled[i] < 1 ? small : large).push_back(std::uint32_t(i));
    }
    while (!small.empty() && !large.empty()) {
        std::uint32_t const s = small.back(), l = large.back();
        small.pop_back();
        table.entries[s].keep = float(scaled[s]);
        table.entries[s].alias = l;
        scaled[l] -= 1.0 - scaled[s];
        if (scaled[l] < 1) {
            large.pop_back();
            small.push_back(l);
        }
    }
    // Bins left over by rounding always keep their own index, except those of weight 0.
    for (std::uint32_t const s : small)
        if (table.entries[s].probability == 0) {
            std::uint32_t heaviest = 0;
            for (std::uint32_t i = 0; i < n; ++i)
                if (table.entries[i].probability > table.entries[heaviest].probability) heaviest = i;
            table.entries[s].keep = 0;
            table.entries[s].alias = heaviest;
        }
    return table;
}

} // namespace gi
