#include "viewer/cli/ar/ar_light_bench.h"

#include "ar/light/map_file.h"
#include "ar/runtime/light_check.h"
#include "viewer/bench/bench_record.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace viewer {

BenchTable measure_light_estimates(LightBenchSettings const& s, gi::StopRequest const& stop, gi::Report& report)
{
    BenchTable table =
        start_table("ar_light", "Light estimated from a frame, against the map that lit it",
                    {"map", "irradiance_rms", "facing_rms", "up_ratio", "mean_ratio", "white_deg", "lamp_deg",
                     "true_lamp_share", "flux_deg", "up_sigmas", "undetermined_share", "unexplained", "flip",
                     "flip_even_light", "flip_of_adding_nothing", "estimate_s"});
    table.facts.emplace_back("frames", fmt::format("{}, 320 x 240, {} paths", s.views, s.paths));
    table.facts.emplace_back("albedos", s.unknown_albedo ? "of the paper alone" : "known");
    std::vector<cv::Mat> maps;
    for (std::string const& file : s.maps) maps.push_back(ar::read_map(file, &report));
    for (std::size_t k = 0; k < maps.size(); ++k) {
        ar::LightCheckSettings settings;
        settings.views = s.views;
        settings.paths = s.paths;
        settings.unknown_albedo = s.unknown_albedo;
        ar::LightChecked const c = ar::check_light(maps[k], settings, stop, report);
        if (stop.requested()) break;
        // Between the strongest lamps: only where the truth has one that matters.
        Cell const lamp = c.truth_lamp_share >= 0.1 && c.lamp_deg >= 0 ? Cell(c.lamp_deg) : Cell();
        auto const flip = [](double v) { return v >= 0 ? Cell(v) : Cell(); };
        table.add({std::filesystem::path(s.maps[k]).stem().string(), c.irradiance_rms, c.facing_rms, c.up_ratio,
                   c.mean_ratio, c.white_deg, lamp, c.truth_lamp_share, c.vector_deg, c.up_sigmas,
                   c.light.undetermined_share, c.light.fit.residual, flip(c.flip), flip(c.flip_even),
                   flip(c.flip_nothing), c.estimate_s});
    }
    std::stable_sort(table.rows.begin(), table.rows.end(),
                     [](auto const& a, auto const& b) { return number(a[1]) > number(b[1]); });
    return table;
}

} // namespace viewer
