#pragma once
// A room that needs no renderer: a floor, a back wall and two balls, with soft patterns. Seen through any camera.

#include "gi/scene/model/camera.h"

#include <glm/vec2.hpp>
#include <vector>

namespace viewer::test {

struct RoomPicture {
    glm::ivec2 size{};
    std::vector<float> rgb;     ///< linear, rows from the top
    std::vector<float> depth_m; ///< along the axis, 0 = nothing
};

inline gi::vec3 soft_pattern(float u, float v, gi::vec3 tint)
{
    float const s = 0.5f + 0.25f * std::sin(3 * u) + 0.25f * std::sin(4 * v);
    return tint * (0.1f + s);
}

/// Colour of what the ray meets; t: along the unit direction, infinite where nothing is met.
inline gi::vec3 room_radiance(gi::Ray const& ray, float& t)
{
    gi::vec3 const o = ray.origin, d = ray.direction;
    t = std::numeric_limits<float>::infinity();
    gi::vec3 color{0.05f, 0.08f, 0.15f};
    auto const plane = [&](float hit, gi::vec3 tint, int a, int b) {
        if (!(hit > 0 && hit < t)) return;
        t = hit;
        gi::vec3 const p = o + hit * d;
        color = soft_pattern(p[a], p[b], tint);
    };
    if (d.y < 0) plane(-o.y / d.y, {0.9f, 0.7f, 0.4f}, 0, 2);
    if (d.z < 0 && o.y - (o.z + 6) / d.z * d.y < 4) plane(-(o.z + 6) / d.z, {0.4f, 0.6f, 1.2f}, 0, 1);
    auto const ball = [&](gi::vec3 middle, float radius, gi::vec3 tint) {
        gi::vec3 const to = o - middle;
        float const b = glm::dot(to, d), q = b * b - glm::dot(to, to) + radius * radius;
        if (q < 0) return;
        float const hit = -b - std::sqrt(q);
        if (!(hit > 0 && hit < t)) return;
        t = hit;
        gi::vec3 const n = (to + hit * d) / radius;
        color = tint * (0.15f + std::max(0.0f, glm::dot(n, glm::normalize(gi::vec3{1, 2, 1})))) +
                4.0f * std::pow(std::max(0.0f, n.y), 60.0f);
    };
    ball({-0.6f, 0.6f, -3}, 0.6f, {1.2f, 0.15f, 0.1f});
    ball({0.9f, 0.9f, -4.2f}, 0.9f, {0.1f, 0.9f, 0.2f});
    return color;
}

inline RoomPicture room_seen_by(gi::Camera const& camera, glm::ivec2 size)
{
    RoomPicture out{size, {}, {}};
    gi::CameraRays const rays = gi::camera_rays(camera, size.x, size.y, gi::dvec3{0});
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            gi::Ray const ray = rays.through({float(x) + 0.5f, float(y) + 0.5f});
            float t = 0;
            gi::vec3 const c = room_radiance(ray, t);
            for (int k = 0; k < 3; ++k) out.rgb.push_back(c[k]);
            out.depth_m.push_back(std::isfinite(t) ? t * glm::dot(ray.direction, rays.forward) : 0);
        }
    return out;
}

/// Eyes 64 mm apart, 1.5 m high, before a screen 2 m away that both see.
inline gi::Camera room_eye(double eye_x, double aspect)
{
    gi::Camera camera;
    camera.world_from_camera = gi::dmat4(1);
    camera.world_from_camera[3] = {eye_x, 1.5, 1.0, 1.0};
    double const half_width = 0.8 * aspect, distance = 2;
    camera.off_axis = gi::ViewTangents{(-half_width - eye_x) / distance, (half_width - eye_x) / distance,
                                       (-0.8 - 0.3) / distance, (0.8 - 0.3) / distance};
    return camera;
}

} // namespace viewer::test
