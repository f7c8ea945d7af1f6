#include "ar/pose/align.h"

#include "ar/base/error.h"
#include "ar/base/rotation_fit.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

using Points = std::vector<glm::dvec3>;

[[noreturn]] void refuse(std::string const& problem, std::string const& why)
{
    throw InputError("alignment of two worlds: " + problem, why,
                     "give at least three points, or poses, at different places in both");
}

glm::dvec3 mean(std::span<glm::dvec3 const> points)
{
    glm::dvec3 sum(0);
    for (glm::dvec3 const& p : points) sum += p;
    return sum / double(points.size());
}

Points about(std::span<glm::dvec3 const> points, glm::dvec3 centre)
{
    Points out(points.begin(), points.end());
    for (glm::dvec3& p : out) p -= centre;
    return out;
}

void finish(Alignment& a)
{
    double sum = 0;
    for (double const r : a.residual_m) sum += r * r;
    a.rms_m = std::sqrt(sum / double(a.residual_m.size()));
    a.worst = std::size_t(std::max_element(a.residual_m.begin(), a.residual_m.end()) - a.residual_m.begin());
}

Points positions(std::span<Pose const> poses)
{
    Points out;
    for (Pose const& p : poses) out.push_back(p.position_m);
    return out;
}

Points with_axes(std::span<Pose const> poses, double length)
{
    Points out;
    for (Pose const& p : poses)
        for (glm::dvec3 const axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
            for (double const sign : {-1.0, 1.0}) out.push_back(p * (sign * length * axis));
    return out;
}

} // namespace

glm::dvec3 apply(Alignment const& a, glm::dvec3 from)
{
    return a.scale * (a.to_from.rotation * from) + a.to_from.position_m;
}

Pose apply(Alignment const& a, Pose const& from)
{
    return {glm::normalize(a.to_from.rotation * from.rotation), apply(a, from.position_m)};
}

Alignment align(std::span<glm::dvec3 const> from, std::span<glm::dvec3 const> to, Scale scale)
{
    if (from.size() != to.size())
        refuse(fmt::format("{} points of one and {} of the other", from.size(), to.size()),
               "they are matched one by one");
    if (from.size() < 3) refuse(fmt::format("{} points", from.size()), "a rotation is free");
    for (auto const points : {from, to})
        for (glm::dvec3 const& p : points)
            if (!std::isfinite(p.x + p.y + p.z)) refuse("a point is not finite", "nothing is nearest to it");
    glm::dvec3 const from_centre = mean(from), to_centre = mean(to);
    Points const f = about(from, from_centre), t = about(to, to_centre);
    auto const rotation = rotation_fit(f, t);
    if (!rotation) refuse("the points lie on a line", "the turn about it is free");
    Alignment a;
    if (scale == Scale::free) {
        double along = 0, own = 0;
        for (std::size_t i = 0; i < f.size(); ++i) {
            along += glm::dot(t[i], *rotation * f[i]);
            own += glm::dot(f[i], f[i]);
        }
        a.scale = along / own;
        if (!(a.scale > 0)) refuse("no positive scale fits", "the points do not match");
    }
    a.to_from = {*rotation, to_centre - a.scale * (*rotation * from_centre)};
    for (std::size_t i = 0; i < from.size(); ++i) a.residual_m.push_back(glm::length(apply(a, from[i]) - to[i]));
    finish(a);
    return a;
}

Alignment align(std::span<Pose const> from, std::span<Pose const> to)
{
    if (from.size() != to.size() || from.empty())
        refuse(fmt::format("{} poses of one and {} of the other", from.size(), to.size()),
               "they are matched one by one");
    Points const places = positions(to);
    double spread = 0;
    glm::dvec3 const centre = mean(places);
    for (glm::dvec3 const& p : places) spread += glm::dot(p - centre, p - centre) / double(places.size());
    double const length = std::max(0.1, std::sqrt(spread));
    Alignment a = align(with_axes(from, length), with_axes(to, length), Scale::fixed);
    a.residual_m.clear();
    for (std::size_t i = 0; i < from.size(); ++i) {
        Pose const there = apply(a, from[i]);
        a.residual_m.push_back(glm::length(there.position_m - to[i].position_m));
        a.residual_deg.push_back(angle_between_deg(there.rotation, to[i].rotation));
    }
    finish(a);
    return a;
}

} // namespace ar
