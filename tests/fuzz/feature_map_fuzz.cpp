// Any text as a map of features: the result is an InputError, or a map that is
// unchanged after writing and reading.

#include "ar/features/feature_map.h"
#include "gi/core/error.h"

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const text(data, data + size);
    try {
        ar::FeatureMap const map = ar::parse_feature_map(text, "fuzz");
        ar::FeatureMap const again = ar::parse_feature_map(ar::format_feature_map(map), "again");
        if (map.points.empty() || again.points.size() != map.points.size()) __builtin_trap();
        for (std::size_t k = 0; k < map.points.size(); ++k) {
            ar::MapPoint const &p = map.points[k], &q = again.points[k];
            if (!(glm::length(p.world_m - q.world_m) < 2e-6) || !std::isfinite(p.sigma_m) || p.sigma_m < 0 ||
                p.descriptors != q.descriptors || p.descriptors.empty())
                __builtin_trap();
        }
    } catch (gi::InputError const&) {
    }
    return 0;
}
