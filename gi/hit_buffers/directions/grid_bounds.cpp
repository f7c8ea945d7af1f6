#include "gi/hit_buffers/directions/grid_bounds.h"

namespace gi {

Bounds grid_bounds(World const& world, TriangleSoup const& soup, std::size_t first_moving)
{
    constexpr float kRoom = 0.25f; // relative to the size of the dynamic geometry
    Bounds moving;
    for (std::size_t t = first_moving; t < soup.count; ++t)
        for (std::size_t c = 0; c < 3; ++c)
            if (vec3 const p = soup.vertex(t, c); all_finite(p)) moving = joined(moving, {p, p});
    if (moving.empty()) return world.bounds;
    vec3 const room{kRoom * max_component(moving.high - moving.low)};
    return joined(world.bounds, {moving.low - room, moving.high + room});
}

bool grow(Bounds& bounds, Bounds const& world)
{
    bool const holds = world.empty() || (glm::all(glm::lessThanEqual(bounds.low, world.low)) &&
                                         glm::all(glm::greaterThanEqual(bounds.high, world.high)));
    if (holds) return false;
    vec3 const room = 0.1f * (world.high - world.low);
    bounds = joined(bounds, {world.low - room, world.high + room});
    return true;
}

} // namespace gi
