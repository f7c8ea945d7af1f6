#pragma once
// Converts posteriors of hierarchical models (study/stats/hierarchical.h) to results with units.

#include "study/analysis/analysis.h"
#include "study/stats/hierarchical.h"

namespace study {

inline Uncertain uncertain(Posterior const& p, int observers) { return {p.mean, {p.low, p.high}, observers}; }

/// @param what  is drawn, for people
inline SamplerSettings sampler_of(AnalysisSettings const& settings, std::string const& what)
{
    SamplerSettings sampler;
    sampler.draws = settings.draws;
    sampler.seed = settings.seed;
    if (settings.progress) sampler.progress = [&settings, what](double share) { settings.progress(what, share); };
    return sampler;
}

/// Posterior means and intervals in the units of the table; `r.participants` and `r.observers` are set.
/// @param to_unit rising, of a value of the parameter
template <class ToUnit>
void fill(HierarchicalResult& r, Hierarchical const& h, ToUnit const& to_unit)
{
    auto const converted = [&](Posterior const& p, int n) {
        double const low = to_unit(p.low), high = to_unit(p.high);
        return Uncertain{to_unit(p.mean), {std::min(low, high), std::max(low, high)}, n};
    };
    r.mean = converted(h.mean, r.observers);
    r.deviation = uncertain(h.deviation, r.observers);
    for (Posterior const& p : h.observer) r.each.push_back(converted(p, 1));
    r.report = h.report;
    r.note = h.note;
}

} // namespace study
