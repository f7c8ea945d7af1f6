#include "viewer/protocol/cluster/swap_log.h"

#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {

std::string to_text(SwapSkew const& s)
{
    if (s.frames == 0) return "swap skew: no frame was reported by several ranks";
    return fmt::format("swap skew of {} frames: median {:.3f} ms, 95 % {:.3f} ms, 99 % {:.3f} ms, most {:.3f} ms "
                       "(clocks +- {:.3f} ms)",
                       s.frames, 1e3 * s.median_s, 1e3 * s.p95_s, 1e3 * s.p99_s, 1e3 * s.most_s,
                       1e3 * s.clock_error_s);
}

void SwapLog::add(std::uint64_t frame, double time_s, double clock_error_s)
{
    auto const [at, fresh] = open_.try_emplace(frame, Open{0, time_s, time_s});
    Open& o = at->second;
    ++o.ranks;
    o.first_s = std::min(o.first_s, time_s);
    o.last_s = std::max(o.last_s, time_s);
    clock_error_s_ = std::max(clock_error_s_, clock_error_s);
    while (!open_.empty() && open_.begin()->first + kLate < frame) {
        Open const& old = open_.begin()->second;
        if (old.ranks > 1) skews_s_.push_back(float(old.last_s - old.first_s));
        open_.erase(open_.begin());
    }
}

SwapSkew SwapLog::skew() const
{
    std::vector<float> all = skews_s_;
    for (auto const& [frame, o] : open_)
        if (o.ranks > 1) all.push_back(float(o.last_s - o.first_s));
    SwapSkew s;
    s.frames = all.size();
    s.clock_error_s = clock_error_s_;
    if (all.empty()) return s;
    all = gi::sorted_values(std::move(all));
    s.median_s = gi::quantile_of_sorted(all, 0.5);
    s.p95_s = gi::quantile_of_sorted(all, 0.95);
    s.p99_s = gi::quantile_of_sorted(all, 0.99);
    s.most_s = gi::quantile_of_sorted(all, 1);
    return s;
}

} // namespace viewer
