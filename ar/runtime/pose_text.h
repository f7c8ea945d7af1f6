#pragma once
// Text about how far camera poses could be trusted in a run.

#include "ar/pose/trust.h"

#include <array>
#include <string>
#include <vector>

namespace ar {

struct PoseTally {
    std::array<std::uint64_t, kPoseStates> states{};     ///< number of frames in each
    std::vector<double> confidence;                      ///< of the frames' own estimates

    void add(PoseState state, double confidence_, bool is_estimated)
    {
        ++states[std::size_t(state)];
        if (is_estimated) confidence.push_back(confidence_);
    }
    /// Frames with a trusted pose of their own.
    std::uint64_t found() const { return states[std::size_t(PoseState::tracked)]; }
};

/// A line of text: frames in each state, median and 5 % quantile of the confidence; empty without frames.
std::string describe(PoseTally const& tally);

} // namespace ar
