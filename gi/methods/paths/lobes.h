#pragma once
// Which kinds of lobes the surfaces of a world have.

#include "gi/scene/model/world.h"

namespace gi {

/// True if some path may have to continue with an exact ray: some lobe is narrow, a mirror or glass.
bool narrow_somewhere(World const& world);
/// True if some surface is a mirror or glass. These do not count as bounces: paths reach lights through them.
bool smooth_somewhere(World const& world);

} // namespace gi
