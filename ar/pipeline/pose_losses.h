#pragma once
// Why frames have no trusted pose of their own, and what of their markers was left out, for reports.

#include "ar/pipeline/pose_finder.h"
#include "gi/core/report.h"

#include <map>

namespace ar {

class PoseLosses {
public:
    /// Counts what the report gets: losses (markers seen twice, boards that contradict the map), counts (markers that
    /// the map does not have, frames without a trusted pose by their cause).
    /// @param prefix  of the counts
    void add(FoundPose const& found, std::uint64_t frame, gi::Report& report, std::string const& prefix = {});

private:
    std::map<std::string, std::uint64_t> frames_;
    std::uint64_t unknown_ = 0;
};

} // namespace ar
