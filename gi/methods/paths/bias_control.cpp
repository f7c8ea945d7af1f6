#include "gi/methods/paths/bias_control.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace gi {

std::size_t BiasControl::stride(std::size_t pixels)
{
    constexpr std::size_t kEnough = 1024, kMostStride = 64;
    return std::clamp<std::size_t>(pixels / kEnough, 1, kMostStride);
}

void BiasControl::add(PassLight const& pass)
{
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        // Means, so that passes of pictures whose size changes weigh the same.
        double const n = double(std::max<std::uint64_t>(1, pass.paths)), exact = pass.exact[k] / n,
                     difference = pass.looked_up[k] / n - exact;
        Moments& m = parts_[k];
        m.difference += difference;
        m.exact += exact;
        m.difference2 += difference * difference;
        m.exact2 += exact * exact;
        m.product += difference * exact;
    }
    ++passes_;
    paths_ += pass.paths;
}

/// Of a ratio of means, by linearisation (Cochran 1977, sec. 2.11).
Deviation BiasControl::deviation(Moments const& m) const
{
    double const of_all = all_light() != 0 ? m.difference / all_light() : m.difference != 0 ? 1 : 0;
    if (m.exact == 0) return {m.difference == 0 ? 0.0 : std::numeric_limits<double>::infinity(), 0, of_all};
    double const n = double(passes_), ratio = m.difference / m.exact,
                 residuals = m.difference2 - 2 * ratio * m.product + ratio * ratio * m.exact2,
                 standard = std::sqrt(std::max(0.0, residuals) * n / (n - 1)) / std::abs(m.exact);
    return {ratio, boost::math::quantile(boost::math::students_t(n - 1), 0.975) * standard, of_all};
}

std::optional<LookUpBias> BiasControl::bias() const
{
    if (passes_ < 3) return {};
    return LookUpBias{deviation(parts_[0]), deviation(parts_[1]), paths_};
}

void report_bias(std::optional<LookUpBias> const& bias, Report& report)
{
    constexpr double kMost = 0.01, kMostOfAll = 0.001;
    if (!bias) return;
    auto const is_wrong = [](Deviation const& d) {
        return std::abs(d.value) - d.error > kMost && std::abs(d.of_all) > kMostOfAll;
    };
    if (!is_wrong(bias->direct) && !is_wrong(bias->indirect)) return;
    report.lose(
        "pictures whose light by look-ups is wrong by more than 1 %: exact are --method paths and reference", 1,
        fmt::format("direct light {:+.1f} +- {:.1f} %, indirect light {:+.1f} +- {:.1f} %",
                    100 * bias->direct.value, 100 * bias->direct.error, 100 * bias->indirect.value,
                    100 * bias->indirect.error));
}

} // namespace gi
