#include "gi/methods/sh_grid/field_glyphs.h"

#include "gi/methods/sh_grid/field_light.h"

namespace gi {
namespace {

/// Distance to where a ray enters a sphere, in units of the ray's direction, or a negative value.
float enter_sphere(vec3 origin, vec3 direction, vec3 center, float radius)
{
    vec3 const to_center = center - origin;
    float const along = glm::dot(to_center, direction);
    float const beside = glm::dot(to_center, to_center) - square(along);
    return beside < square(radius) ? along - std::sqrt(square(radius) - beside) : -1.0f;
}

} // namespace

std::optional<Glyph> nearest_glyph(CellsView<FieldCell> const& cells, int degree, Ray const& ray, float reach)
{
    GridFrame const& frame = cells.frame;
    vec3 const from = (ray.origin - frame.low) / frame.cell, end = vec3(frame.size);
    vec3 inverse;
    for (int axis = 0; axis < 3; ++axis) {
        float const d = ray.direction[axis];
        inverse[axis] = 1 / (std::abs(d) < 1e-9f ? std::copysign(1e-9f, d) : d);
    }
    vec3 const to_low = -from * inverse, to_high = (end - from) * inverse;
    constexpr float kStep = 1e-4f; // past borders, cells
    float t = std::max(max_component(glm::min(to_low, to_high)), 0.0f) + kStep;
    float const stop = std::min(min_component(glm::max(to_low, to_high)), reach / frame.cell);
    while (t < stop) {
        glm::ivec3 const c{glm::floor(from + t * ray.direction)};
        if (FieldCell const* const cell = cells.find(c)) {
            vec3 const center = vec3(c) + 0.5f;
            float const at = enter_sphere(from, ray.direction, center, kGlyphRadius);
            if (at > 0 && at < stop) {
                vec3 const normal = (from + at * ray.direction - center) / kGlyphRadius;
                return Glyph{at * frame.cell, normal, field_radiance(*cell, degree, normal)};
            }
        }
        vec3 const leaves = glm::max((vec3(c) - from) * inverse, (vec3(c) + 1.0f - from) * inverse);
        t = std::max(min_component(leaves), t) + kStep;
    }
    return std::nullopt;
}

} // namespace gi
