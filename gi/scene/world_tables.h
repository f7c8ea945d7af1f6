#pragma once
// What build_world derives from the arrays of a World once they are there.

#include "gi/base/report.h"

namespace gi {

struct World;

/// Fill World::surfaces and bsdfs from its triangles and materials.
void build_surfaces(World& world);
/// Fill World::emitters, emitter_pdf, light_select, environment_select, environment_pdf from its surfaces and lights.
void build_light_tables(World& world, Report& report);

} // namespace gi
