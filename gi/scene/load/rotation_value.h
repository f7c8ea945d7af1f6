#pragma once
#include "gi/core/yaml.h"

namespace gi {

/// [x, y, z] degrees about x, then y, then z; or {axis, degrees}, right-handed, about +Y without an axis.
dmat4 read_rotation(Yaml const& value);

} // namespace gi
