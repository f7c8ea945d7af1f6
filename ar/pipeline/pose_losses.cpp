#include "ar/pipeline/pose_losses.h"

#include <fmt/format.h>

namespace ar {

void PoseLosses::add(FoundPose const& f, std::uint64_t frame, gi::Report& report, std::string const& prefix)
{
    Sighting const& s = f.sighting;
    if (s.markers_ambiguous > 0)
        report.lose("markers left out: their identifier is in the picture more than once",
                    std::uint64_t(s.markers_ambiguous), fmt::format("{}, frame {}", s.ambiguous.front(), frame));
    for (std::string const& why : s.contradictions)
        report.lose("boards left out: the picture contradicts the map", 1,
                    fmt::format("{}, frame {}", why, frame));
    if (s.markers_unknown > 0)
        report.count(prefix + "markers that the map does not have",
                     double(unknown_ += std::uint64_t(s.markers_unknown)));
    if (!f.lost_by.empty())
        report.count(fmt::format("{}frames without a trusted pose: {}", prefix, f.lost_by),
                     double(++frames_[f.lost_by]));
}

} // namespace ar
