#pragma once
#include "gi/scene/load/yaml_reader.h"

namespace gi {

/// Reads a rotation: [x, y, z] degrees about x, then y, then z; or {axis, degrees}, right-handed, default axis +Y.
dmat4 read_rotation(YamlReader const& value);

} // namespace gi
