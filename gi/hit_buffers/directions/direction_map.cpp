#include "gi/hit_buffers/directions/direction_map.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

namespace {

/// Searches `count` axes, whose numbers `axis` returns in ascending order.
template <class AxisAt>
std::uint32_t nearest_of(DirectionSet const& directions, dvec3 d, std::size_t count, AxisAt const& axis)
{
    std::size_t best = 0;
    double largest = -1;
    for (std::size_t i = 0; i < count; ++i) {
        double const cosine = glm::dot(directions.axes[axis(i)], d);
        if (std::abs(cosine) > largest) {
            largest = std::abs(cosine);
            best = 2 * axis(i) + (cosine < 0);
        }
    }
    return std::uint32_t(best);
}

} // namespace

std::uint32_t nearest_direction(DirectionSet const& directions, dvec3 d)
{
    return nearest_of(directions, d, directions.axes.size(), [](std::size_t i) { return i; });
}

NearestDirections::NearestDirections(DirectionSet const& directions) : directions_(directions)
{
    constexpr double kRounding = 1e-4; // rad; margin for rounding when a direction's cell is found
    std::vector<double> cosines(directions.axes.size());
    for (std::uint32_t y = 0; y < kAcross; ++y)
        for (std::uint32_t x = 0; x < kAcross; ++x) {
            auto const at = [&](float u, float v) {
                return glm::normalize(
                    dvec3(direction_from_octahedral(vec2{float(x) + u, float(y) + v} / float(kAcross))));
            };
            auto const angle = [](double cosine) { return std::acos(std::min(cosine, 1.0)); };
            // A cell is one or two spherical triangles: no point in it is farther from its centre than a corner.
            dvec3 const middle = at(0.5f, 0.5f);
            double radius = 0;
            for (vec2 const corner : {vec2{0, 0}, vec2{1, 0}, vec2{0, 1}, vec2{1, 1}})
                radius = std::max(radius, angle(glm::dot(middle, at(corner.x, corner.y))));
            for (std::size_t i = 0; i < cosines.size(); ++i)
                cosines[i] = std::abs(glm::dot(directions.axes[i], middle));
            double const limit = angle(*std::max_element(cosines.begin(), cosines.end())) + 2 * radius + kRounding;
            first_.push_back(std::uint32_t(axes_.size()));
            for (std::size_t i = 0; i < cosines.size(); ++i)
                if (cosines[i] >= std::cos(limit)) axes_.push_back(std::uint32_t(i));
        }
    first_.push_back(std::uint32_t(axes_.size()));
}

std::uint32_t NearestDirections::operator()(dvec3 d) const
{
    vec2 const uv = octahedral_from_direction(vec3(d)) * float(kAcross);
    auto const cell = [](float u) { return std::min(std::uint32_t(std::max(u, 0.0f)), kAcross - 1); };
    std::uint32_t const* const first = &first_[cell(uv.y) * kAcross + cell(uv.x)];
    return nearest_of(directions_, d, first[1] - first[0], [&](std::size_t i) { return axes_[first[0] + i]; });
}

DirectionMap make_direction_map(DirectionSet const& directions, SphereMapping mapping, std::uint32_t size)
{
    DirectionMap map;
    map.mapping = mapping;
    map.height = size;
    map.width = mapping == SphereMapping::octahedral ? size : 2 * size;
    map.nearest.resize(std::size_t(map.width) * map.height);
    NearestDirections const nearest(directions);
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
            map.nearest[std::size_t(y) * map.width + x] = std::uint16_t(nearest(d));
        }
    });
    return map;
}

} // namespace gi
