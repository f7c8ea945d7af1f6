#include "gi/slhb/direction_map.h"

#include <tbb/parallel_for.h>

namespace gi {

std::uint32_t nearest_direction(DirectionSet const& directions, dvec3 d)
{
    std::size_t best = 0;
    double largest = -1;
    for (std::size_t i = 0; i < directions.axes.size(); ++i) {
        double const cosine = glm::dot(directions.axes[i], d);
        if (std::abs(cosine) > largest) {
            largest = std::abs(cosine);
            best = 2 * i + (cosine < 0);
        }
    }
    return std::uint32_t(best);
}

DirectionMap make_direction_map(DirectionSet const& directions, SphereMapping mapping, std::uint32_t size)
{
    DirectionMap map;
    map.mapping = mapping;
    map.height = size;
    map.width = mapping == SphereMapping::octahedral ? size : 2 * size;
    map.nearest.resize(std::size_t(map.width) * map.height);
    tbb::parallel_for(0u, map.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < map.width; ++x) {
            double const u = (x + 0.5) / map.width, v = (y + 0.5) / map.height;
            dvec3 d;
            if (mapping == SphereMapping::octahedral) {
                d = dvec3(direction_from_octahedral({float(u), float(v)}));
            } else {
                double const phi = 2 * glm::pi<double>() * (u - 0.5), theta = glm::pi<double>() * v;
                d = {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
            }
            map.nearest[std::size_t(y) * map.width + x] = std::uint16_t(nearest_direction(directions, d));
        }
    });
    return map;
}

} // namespace gi
