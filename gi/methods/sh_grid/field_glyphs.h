#pragma once
// The field as spheres at the centres of its cells, to be looked at: each point of a sphere shows the radiance
// that arrives at the cell's centre from the direction of the sphere's normal there (Chang, Park and Ihm, fig. 7).

#include "gi/methods/sh_grid/field.h"
#include "gi/methods/whitted/tree_tracer.h"

#include <optional>

namespace gi {

/// Radius of a sphere, cells.
inline constexpr float kGlyphRadius = 0.12f;

/// The first sphere along a ray. @param reach  m; farther ones are ignored
std::optional<Glyph> nearest_glyph(CellsView<FieldCell> const& cells, int degree, Ray const& ray, float reach);

} // namespace gi
