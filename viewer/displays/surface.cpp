#include "viewer/displays/surface.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace viewer {
namespace {

constexpr double kFarthest_m = 1e6;

gi::dvec3 sphere_direction(double azimuth_rad, double elevation_rad)
{
    return {std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad),
            -std::cos(elevation_rad) * std::cos(azimuth_rad)};
}

ViewportCircle circle_of(Surface const& s, double aspect)
{
    if (s.circle) return *s.circle;
    return {0.5, 0.5, aspect > 1 ? 0.5 / aspect : 0.5, aspect > 1 ? 0.5 : 0.5 * aspect};
}

std::optional<gi::dvec3> fisheye_direction(Surface const& s, double aspect, glm::dvec2 uv)
{
    ViewportCircle const c = circle_of(s, aspect);
    glm::dvec2 const at{(uv.x - c.x) / c.half_width, (uv.y - c.y) / c.half_height};
    double const r = std::hypot(at.x, at.y);
    if (!(r <= 1)) return {};
    double const theta = r * glm::radians(s.fov_deg) / 2, share = r > 0 ? std::sin(theta) / r : 0;
    return gi::dvec3{share * at.x, share * at.y, -std::cos(theta)};
}

/// Distance along a ray to a sphere about `center`: the first crossing from outside, or the far one.
std::optional<double> to_sphere(gi::dvec3 from, gi::dvec3 along, gi::dvec3 center, double radius, bool is_first)
{
    gi::dvec3 const to = center - from;
    double const middle = glm::dot(to, along), squared = radius * radius - glm::dot(to, to) + middle * middle;
    if (!(squared >= 0)) return {};
    double const t = is_first ? middle - std::sqrt(squared) : middle + std::sqrt(squared);
    if (!(t > 0)) return {};
    return t;
}

/// On the sphere, in the surface's frame.
std::optional<gi::dvec3> mirrored(Surface const& s, glm::dvec2 uv)
{
    SphericalMirror const& m = s.mirror;
    auto const& [left, right, bottom, top] = m.projector_tangents;
    RoomPose const lens = pose_of(m.projector);
    gi::dvec3 const along =
        lens.rotation * glm::normalize(gi::dvec3{glm::mix(left, right, uv.x), glm::mix(bottom, top, uv.y), -1});
    auto const t = to_sphere(lens.position, along, m.center_m, m.radius_m, true);
    if (!t) return {};
    gi::dvec3 const on_mirror = lens.position + *t * along;
    gi::dvec3 const reflected = glm::reflect(along, (on_mirror - m.center_m) / m.radius_m);
    auto const far = to_sphere(on_mirror, reflected, gi::dvec3{0}, s.radius_m, false);
    if (!far) return {};
    gi::dvec3 const point = on_mirror + *far * reflected;
    if (-point.z < s.radius_m * std::cos(glm::radians(s.fov_deg) / 2) - 1e-9 * s.radius_m) return {};
    return point;
}

std::optional<gi::dvec3> in_frame(Surface const& s, double aspect, glm::dvec2 uv)
{
    double const size = s.radius_m > 0 ? s.radius_m : 1;
    auto const between = [](glm::dvec2 ends, double share) {
        return glm::radians(glm::mix(ends.x, ends.y, share));
    };
    switch (s.type) {
    case SurfaceType::fisheye: {
        auto const direction = fisheye_direction(s, aspect, uv);
        if (!direction) return {};
        return size * *direction;
    }
    case SurfaceType::cylindrical: {
        gi::dvec3 const level = size * sphere_direction(between(s.azimuths_deg, uv.x), 0);
        return gi::dvec3{level.x, glm::mix(s.heights_m.x, s.heights_m.y, uv.y), level.z};
    }
    case SurfaceType::equirectangular:
        return size * sphere_direction(between(s.azimuths_deg, uv.x), between(s.elevations_deg, uv.y));
    case SurfaceType::points:
        return s.points.map ? value_at(*s.points.map, uv) : std::nullopt;
    case SurfaceType::spherical_mirror:
        break;
    }
    return mirrored(s, uv);
}

} // namespace

char const* name_of(SurfaceType type)
{
    switch (type) {
    case SurfaceType::fisheye:
        return "fisheye";
    case SurfaceType::cylindrical:
        return "cylindrical";
    case SurfaceType::equirectangular:
        return "equirectangular";
    case SurfaceType::points:
        return "points";
    case SurfaceType::spherical_mirror:
        break;
    }
    return "spherical-mirror";
}

std::optional<SurfacePoint> surface_point(Surface const& s, double aspect, glm::dvec2 uv)
{
    auto const at = in_frame(s, aspect, uv);
    if (!at) return {};
    RoomPose const pose = pose_of(s.place);
    if (s.radius_m > 0 || s.type == SurfaceType::points)
        return SurfacePoint{pose.position + pose.rotation * *at, false};
    return SurfacePoint{pose.rotation * *at, true};
}

double distance_of(Surface const& s, gi::dvec3 eye)
{
    if (s.type != SurfaceType::points) return s.radius_m;
    constexpr int kAlong = 64; // each side
    double nearest = 0;
    for (int j = 0; j < kAlong; ++j)
        for (int i = 0; i < kAlong; ++i)
            if (auto const p = surface_point(s, 1, {(i + 0.5) / kAlong, (j + 0.5) / kAlong})) {
                double const m = glm::distance(p->at, eye);
                if (nearest == 0 || m < nearest) nearest = m;
            }
    return nearest;
}

gi::dvec3 direction_to(SurfacePoint const& point, gi::dvec3 eye)
{
    gi::dvec3 const to = point.is_direction ? point.at : point.at - eye;
    double const length = glm::length(to);
    return length > 0 ? to / length : gi::dvec3{0};
}

std::optional<SurfaceFault> find_fault(Surface const& s)
{
    auto const within = [](double x, double low, double high) { return x >= low && x <= high; }; // false for NaN
    bool const is_mirror = s.type == SurfaceType::spherical_mirror;
    for (int i = 0; i < 3; ++i)
        if (!within(s.place.translation_m[i], -kFarthest_m, kFarthest_m) ||
            !within(s.place.rotation_deg[i], -3600, 3600))
            return SurfaceFault{"center_m", "the surface's place is not finite or too far away",
                                "it lies somewhere in the room", "metres and degrees"};
    if (!within(s.radius_m, 0, kFarthest_m) || (s.radius_m > 0 && s.radius_m < 1e-3))
        return SurfaceFault{"radius_m", fmt::format("a radius of {:g} m", s.radius_m),
                            "1 mm to 1000 km are handled", "leave it out if the eye's place does not count"};
    if (s.radius_m == 0 && (is_mirror || s.type == SurfaceType::cylindrical))
        return SurfaceFault{"radius_m", "radius_m is missing",
                            std::string(name_of(s.type)) + " needs the size of the surface", "radius_m: 5"};
    if (s.type == SurfaceType::points && !s.points.map)
        return SurfaceFault{"file", "file is missing", "it says which point each pixel lights",
                            "file: left.pfm, with unit_m: 0.001 if it is in mm"};
    if (!within(s.unit_m, 1e-6, 1e6))
        return SurfaceFault{"unit_m", fmt::format("a unit of {:g} m", s.unit_m), "1e-6 to 1e6 are handled",
                            "0.001 for millimetres, 0.01 for centimetres"};
    if (!within(s.fov_deg, 1, 360))
        return SurfaceFault{"fov_deg", fmt::format("a field of view of {:g} degrees", s.fov_deg),
                            "1 to 360 degrees are handled", "180 is a hemisphere"};
    for (auto const& [key, ends, least, most] : {std::tuple{"azimuths_deg", s.azimuths_deg, -720.0, 720.0},
                                                 {"elevations_deg", s.elevations_deg, -90.0, 90.0},
                                                 {"heights_m", s.heights_m, -kFarthest_m, kFarthest_m}})
        if (!within(ends.x, least, most) || !within(ends.y, least, most) || ends.y - ends.x < 1e-6)
            return SurfaceFault{key, fmt::format("{} from {:g} to {:g}", key, ends.x, ends.y),
                                "the second is larger than the first, and both are in range",
                                "give [left, right] or [bottom, top]"};
    if (s.azimuths_deg.y - s.azimuths_deg.x > 360 + 1e-9)
        return SurfaceFault{"azimuths_deg", "more than a full turn", "a part would be shown twice", "[-180, 180]"};
    if (s.circle && (!within(s.circle->half_width, 1e-3, 1000) || !within(s.circle->half_height, 1e-3, 1000) ||
                     !within(s.circle->x, -1000, 1000) || !within(s.circle->y, -1000, 1000)))
        return SurfaceFault{"circle", "the circle is too small, too large or not finite",
                            "it is [x, y, half width, half height] in fractions of the viewport",
                            "[0.5, 0.5, 0.5, 0.5] fills it"};
    if (!is_mirror) return {};
    SphericalMirror const& m = s.mirror;
    auto const& t = m.projector_tangents;
    for (double const x : t)
        if (!within(x, -100, 100) || !(t[0] < t[1]) || !(t[2] < t[3]))
            return SurfaceFault{"projector_tangents", "the projector's picture has no area",
                                "it is [left, right, bottom, top] at distance 1", "[-0.5, 0.5, -0.28, 0.28]"};
    for (int i = 0; i < 3; ++i)
        if (!within(m.center_m[i], -kFarthest_m, kFarthest_m) ||
            !within(m.projector.translation_m[i], -kFarthest_m, kFarthest_m) ||
            !within(m.projector.rotation_deg[i], -3600, 3600))
            return SurfaceFault{"mirror_center_m",
                                "the mirror's or the projector's place is not finite or too far",
                                "both are near the surface", "metres and degrees, in the surface's frame"};
    if (!within(m.radius_m, 1e-4, s.radius_m) || glm::length(m.center_m) + m.radius_m > 2 * s.radius_m)
        return SurfaceFault{"mirror_radius_m", fmt::format("a mirror of {:g} m radius", m.radius_m),
                            "the ball is smaller than the surface and near it", "mirror_radius_m: 0.3"};
    if (glm::length(m.projector.translation_m - m.center_m) <= m.radius_m * (1 + 1e-9))
        return SurfaceFault{"projector_position_m", "the projector is within the mirror", "it could light nothing",
                            "give its place in the surface's frame"};
    return {};
}

} // namespace viewer
