#include "study/display/display_model.h"

#include "study/numeric/root.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

/// Linear between the entries of a rising table, which begins at (0, 0) and ends at (1, 1).
double along(std::vector<std::pair<double, double>> const& table, double value)
{
    auto const above = std::lower_bound(table.begin(), table.end(), value,
                                        [](auto const& entry, double v) { return entry.first < v; });
    if (above == table.begin()) return above->second;
    if (above == table.end()) return table.back().second;
    auto const& [x0, y0] = *std::prev(above);
    return y0 + (above->second - y0) * (value - x0) / (above->first - x0);
}

} // namespace

double share_of_value(DisplayLuminance const& light, int channel, double value)
{
    ChannelCurve const& c = light.channels[std::size_t(channel)];
    double const v = std::clamp(value, 0.0, 1.0);
    if (light.uses_table && c.table.size() > 1) return along(c.table, v);
    double const low = std::pow(std::max(0.0, 1 - c.gain), c.gamma); // what black emits already
    double const share = std::pow(std::max(0.0, c.gain * v + 1 - c.gain), c.gamma);
    return std::clamp((share - low) / (1 - low), 0.0, 1.0);
}

double value_of_share(DisplayLuminance const& light, int channel, double share)
{
    if (!(share > 0)) return 0;
    if (share >= 1) return 1;
    return bisect([&](double v) { return share_of_value(light, channel, v) - share; }, 0, 1);
}

std::vector<std::array<float, 3>> inverse_table(DisplayLuminance const& light, int steps)
{
    std::vector<std::array<float, 3>> table(static_cast<std::size_t>(steps));
    for (int i = 0; i < steps; ++i)
        for (int c = 0; c < 3; ++c)
            table[std::size_t(i)][std::size_t(c)] =
                float(value_of_share(light, c, std::pow(double(i) / (steps - 1), kInverseTableExponent)));
    return table;
}

} // namespace study
