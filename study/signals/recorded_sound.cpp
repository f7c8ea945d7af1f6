#include "gi/core/error.h"
#include "gi/core/quantile.h"
#include "study/signals/photodiode.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {

DiodeSignal heard(DiodeSignal signal, double threshold, double hold_ms)
{
    std::vector<double> loud;
    for (double const v : signal.light) loud.push_back(std::abs(v));
    double const most = loud.empty() ? 0 : *std::max_element(loud.begin(), loud.end());
    // Sounds fill less than half of a recording: the median is that of the pauses.
    double const noise = loud.empty() ? 0 : gi::median(loud);
    if (!(most > 0) || noise > threshold * most / 3)
        throw gi::InputError(
            most > 0 ? fmt::format("the pauses are as loud as {:.1f} % of the loudest sample", 100 * noise / most)
                     : std::string("the recording is silent"),
            fmt::format("sounds are told from pauses at {:.1f} %", 100 * threshold),
            "record closer or louder, or raise --threshold");
    double last_s = -1e300; // when it was last that loud
    for (std::size_t i = 0; i < loud.size(); ++i) {
        if (loud[i] > threshold * most) last_s = signal.time_s[i];
        signal.light[i] = signal.time_s[i] - last_s <= 1e-3 * hold_ms ? 1 : 0;
    }
    return signal;
}

} // namespace study
