#pragma once
// Errors of light estimated from frames of the synthetic desk under given environment
// maps (ar/runtime/light_check.h).

#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "viewer/report/table.h"

namespace viewer {

struct LightBenchSettings {
    std::vector<std::string> maps{}; ///< files
    int views = 1;
    std::uint32_t paths = 64;
    bool unknown_albedo = false;
};

/// One row per map, the worst (irradiance_rms) first. @throws gi::InputError a map cannot be read
BenchTable measure_light_estimates(LightBenchSettings const& settings, gi::StopRequest const& stop,
                                   gi::Report& report);

} // namespace viewer
