#include "viewer/experiment/looked/dwell.h"

#include <cmath>

namespace viewer {

void Dwell::add(DwellTarget const& target, std::size_t offset, double seconds, bool is_by_mirror)
{
    Sums& s = on_[target];
    s.seconds.resize(offsets_);
    s.seconds[offset] += seconds;
    if (is_by_mirror) s.by_mirror += seconds;
}

void Dwell::add(Dwell const& other)
{
    for (auto const& [target, theirs] : other.on_) {
        Sums& s = on_[target];
        s.seconds.resize(offsets_);
        for (std::size_t i = 0; i < offsets_; ++i) s.seconds[i] += theirs.seconds[i];
        s.by_mirror += theirs.by_mirror;
    }
}

std::map<DwellTarget, DwellOn> Dwell::all() const
{
    std::map<DwellTarget, DwellOn> result;
    double const n = double(offsets_);
    for (auto const& [target, s] : on_) {
        DwellOn d;
        for (double const v : s.seconds) d.seconds += v / n;
        for (double const v : s.seconds) d.se += (v - d.seconds) * (v - d.seconds) / n;
        d.se = std::sqrt(d.se);
        d.by_mirror_s = s.by_mirror / n;
        result[target] = d;
    }
    return result;
}

} // namespace viewer
