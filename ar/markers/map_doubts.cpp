#include "ar/markers/map_doubts.h"

#include <algorithm>
#include <fmt/format.h>

namespace ar {
namespace {

constexpr double kWidest_m = 3, kNarrowest_m = 0.005, kFarthest_m = 100;

class Doubts {
public:
    void size(std::string const& what, double width_m, double height_m)
    {
        double const wide = std::max(width_m, height_m);
        if (wide <= kWidest_m && wide >= kNarrowest_m) return;
        std::string const instead = wide > kWidest_m
                                        ? fmt::format("if it is {:.4g} mm, write {:.4g}", wide, 1e-3 * wide)
                                        : fmt::format("these are {:.3g} mm", 1e3 * wide);
        all.push_back(fmt::format("{} is {:.4g} m wide: are its lengths in metres? {}", what, wide, instead));
    }
    void place(std::string const& what, gi::RigidPose const& pose)
    {
        double const far = glm::length(pose.position);
        if (far > kFarthest_m)
            all.push_back(fmt::format("{} is {:.4g} m from the origin: is its position in metres?", what, far));
    }
    std::vector<std::string> all;
};

} // namespace

std::vector<std::string> doubts_about(MarkerMap const& map)
{
    Doubts doubts;
    int thing = 0;
    for (Marker const& m : map.markers) {
        std::string const what = describe(map, thing++);
        doubts.size(what, m.side_m, m.side_m);
        doubts.place(what, m.world_from_marker);
    }
    for (CharucoBoard const& b : map.boards) {
        std::string const what = describe(map, thing++);
        doubts.size(what, b.squares_x * b.square_m, b.squares_y * b.square_m);
        doubts.place(what, b.world_from_board);
    }
    for (MarkerGrid const& g : map.grids) {
        std::string const what = describe(map, thing++);
        auto const width = [&](int n) { return n * g.marker_m + (n - 1) * g.gap_m; };
        doubts.size(what, width(g.markers_x), width(g.markers_y));
        doubts.place(what, g.world_from_grid);
    }
    return doubts.all;
}

void report_doubts(MarkerMap const& map, std::string const& where, gi::Report& report)
{
    for (std::string const& doubt : doubts_about(map))
        report.lose("in doubt: sizes and places of markers", 1, fmt::format("'{}': {}", where, doubt));
}

} // namespace ar
