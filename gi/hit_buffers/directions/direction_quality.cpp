#include "gi/hit_buffers/directions/direction_quality.h"

#include <algorithm>
#include <cmath>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace gi {
namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;

/// Point i of a Fibonacci lattice of n points on the sphere.
dvec3 lattice_point(std::size_t i, std::size_t n)
{
    double const z = 1 - (2 * double(i) + 1) / double(n), turns = double(i) * 0.61803398874989484820;
    double const r = std::sqrt(std::max(0.0, 1 - z * z)), phi = kTurn * (turns - std::floor(turns));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Angle between unit vectors; also accurate for small angles.
double angle(dvec3 a, dvec3 b) { return 2 * std::atan2(glm::length(a - b), glm::length(a + b)); }

struct Gaps {
    std::vector<std::size_t> nearest_to; ///< points per axis
    double largest = 0, sum = 0;

    void add(Gaps const& o)
    {
        nearest_to.resize(std::max(nearest_to.size(), o.nearest_to.size()));
        for (std::size_t i = 0; i < o.nearest_to.size(); ++i) nearest_to[i] += o.nearest_to[i];
        largest = std::max(largest, o.largest);
        sum += o.sum;
    }
};

/// @param with_gaps  false = compute only `nearest_to`
Gaps find_gaps(DirectionSet const& directions, std::size_t samples, bool with_gaps)
{
    NearestDirections const nearest(directions);
    using Range = tbb::blocked_range<std::size_t>;
    Gaps all = tbb::parallel_deterministic_reduce(
        Range(0, samples, 4096), Gaps{},
        [&](Range const& range, Gaps part) {
            part.nearest_to.resize(directions.axes.size());
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                dvec3 const d = lattice_point(i, samples);
                std::uint32_t const k = nearest(d);
                ++part.nearest_to[k / 2];
                if (!with_gaps) continue;
                double const gap = angle(d, directions.direction(k));
                part.largest = std::max(part.largest, gap);
                part.sum += gap;
            }
            return part;
        },
        [](Gaps a, Gaps const& b) {
            a.add(b);
            return a;
        });
    all.nearest_to.resize(directions.axes.size());
    return all;
}

} // namespace

std::vector<double> solid_angles(DirectionSet const& directions, std::size_t samples)
{
    std::vector<double> out;
    for (std::size_t const n : find_gaps(directions, samples, false).nearest_to)
        out.push_back(kTurn * double(n) / double(samples));
    return out;
}

DirectionQuality measure(DirectionSet const& directions, std::size_t samples)
{
    Gaps const gaps = find_gaps(directions, samples, true);
    DirectionQuality q;
    q.largest_gap_rad = gaps.largest;
    q.mean_gap_rad = gaps.sum / double(samples);
    double const mean = double(samples) / double(directions.axes.size());
    auto const [least, most] = std::ranges::minmax(gaps.nearest_to);
    q.smallest_solid_angle = double(least) / mean;
    q.largest_solid_angle = double(most) / mean;
    double squares = 0;
    for (std::size_t const n : gaps.nearest_to) squares += std::pow(double(n) / mean - 1, 2);
    q.solid_angle_deviation = std::sqrt(squares / double(directions.axes.size()));
    return q;
}

MapQuality measure(DirectionMapView const& map, DirectionSet const& directions, std::size_t samples)
{
    MapQuality q;
    for (std::size_t i = 0; i < samples; ++i) {
        dvec3 const d = lattice_point(i, samples);
        std::uint32_t const answer = map.look_up(vec3(d)), truth = nearest_direction(directions, d);
        if (answer == truth) continue;
        double const excess = angle(d, directions.direction(answer)) - angle(d, directions.direction(truth));
        if (!(excess > 0)) continue; // a tie
        q.wrong_share += 1;
        q.mean_excess_rad += excess;
        q.largest_excess_rad = std::max(q.largest_excess_rad, excess);
    }
    q.wrong_share /= double(samples);
    q.mean_excess_rad /= double(samples);
    return q;
}

} // namespace gi
