#pragma once
#include "gi/core/yaml.h"

namespace gi {

/// Reads a rotation: [x, y, z] degrees about x, then y, then z; or {axis, degrees}, right-handed, default axis +Y.
dmat4 read_rotation(Yaml const& value);

} // namespace gi
