#include "viewer/displays/wall_ray.h"

#include <algorithm>

namespace viewer {

namespace {

constexpr glm::dvec2 kMenu_m{0.75, 0.95};
constexpr double kMostOfWall = 0.8;

} // namespace

std::optional<WallHit> hit_plane(Display const& display, int wall, RoomPose const& wand)
{
    WallFrame const f = wall_frame(display.walls[std::size_t(wall)].corners);
    gi::dvec3 const way = wand.rotation * gi::dvec3{0, 0, -1};
    double const towards = -glm::dot(way, f.normal), height = glm::dot(wand.position - f.lower_left, f.normal);
    if (!(towards > 1e-6) || !(height > 0)) return {}; // along the wall, away from it, or from behind
    WallHit hit;
    hit.wall = wall;
    hit.distance_m = height / towards;
    gi::dvec3 const at = wand.position + hit.distance_m * way - f.lower_left;
    hit.u = glm::dot(at, f.right) / f.width_m;
    hit.v = glm::dot(at, f.up) / f.height_m;
    return hit;
}

std::optional<WallHit> hit_wall(Display const& display, RoomPose const& wand, int rank)
{
    std::optional<WallHit> nearest;
    for (std::size_t w = 0; w < display.walls.size(); ++w) {
        if ((rank >= 0 && display.walls[w].rank != rank) || display.walls[w].surface) continue;
        auto const hit = hit_plane(display, int(w), wand);
        if (!hit || hit->u < 0 || hit->u > 1 || hit->v < 0 || hit->v > 1) continue;
        if (!nearest || hit->distance_m < nearest->distance_m) nearest = hit;
    }
    return nearest;
}

WallRectangle menu_place(WallFrame const& wall, double u, double v)
{
    WallRectangle r;
    r.width = std::min(kMenu_m.x / wall.width_m, kMostOfWall);
    r.height = std::min(kMenu_m.y / wall.height_m, kMostOfWall);
    r.left = std::clamp(u - 0.5 * r.width, 0.0, 1 - r.width);
    r.bottom = std::clamp(v - 0.5 * r.height, 0.0, 1 - r.height);
    return r;
}

} // namespace viewer
