#include "ar/runtime/pose_text.h"

#include "gi/core/quantile.h"

#include <fmt/format.h>

namespace ar {

std::string describe(PoseTally const& t)
{
    std::string states;
    for (std::size_t k = 0; k < kPoseStates; ++k)
        if (t.states[k] > 0)
            states += fmt::format("{}{} {}", states.empty() ? "" : ", ", t.states[k], name_of(PoseState(k)));
    if (states.empty()) return {};
    std::string text = "poses: " + states;
    if (!t.confidence.empty())
        text += fmt::format("; confidence {:.3f} (median), {:.3f} (5 %)", gi::quantile(t.confidence, 0.5),
                            gi::quantile(t.confidence, 0.05));
    return text + "\n";
}

} // namespace ar
