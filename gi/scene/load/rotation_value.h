#pragma once
#include "gi/scene/load/yaml_reader.h"

namespace gi {

/// [x, y, z] degrees about x, then y, then z; or {axis, degrees}, right-handed, about +Y without an axis.
dmat4 read_rotation(YamlReader const& value);

} // namespace gi
