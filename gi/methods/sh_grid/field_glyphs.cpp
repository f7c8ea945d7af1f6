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
    constexpr float kStep = 1e-4f; // past borders, cells
    GridFrame const& frame = cells.frame;
    GridRay const in((ray.origin - frame.low) / frame.cell, ray.direction, vec3(frame.size), 0);
    float const stop = std::min(in.length, reach / frame.cell - in.skipped);
    for (float t = kStep; t < stop;) {
        glm::ivec3 const c{glm::floor(in.from + t * ray.direction)};
        if (FieldCell const* const cell = cells.find(c)) {
            vec3 const center = vec3(c) + 0.5f;
            float const at = enter_sphere(in.from, ray.direction, center, kGlyphRadius);
            if (at > 0 && at < stop) {
                vec3 const normal = (in.from + at * ray.direction - center) / kGlyphRadius;
                return Glyph{(in.skipped + at) * frame.cell, normal, field_radiance(*cell, degree, normal)};
            }
        }
        t = std::max(in.leaves(vec3(c), 1), t) + kStep;
    }
    return std::nullopt;
}

} // namespace gi
