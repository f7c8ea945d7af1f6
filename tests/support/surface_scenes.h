#pragma once
// Scenes that hold every kind of material, mesh and light that surfaces know.

#include "gi/scene/model/scene.h"

#include <string>
#include <vector>

namespace gi::test {

/// Panels side by side, one for each kind of material; a sun, a lamp and a spot, if asked for.
Scene material_panels(bool lit);
/// Balls that share a mesh, mirrored about one, two and three axes and sheared; boxes that shine on one side; with and without
/// normals, tangents, vertex colours.
Scene mirrored_balls();
/// A turned, tinted environment map behind balls and panes of glass.
Scene sky_balls();
/// A skinned bar, a morphing panel, a turning box with a normal map, one that turns inside out; for times of 0 to 1 s.
Scene moving_parts();
/// Three blended panels, each of one alpha, over matt ones; the first three materials are theirs.
Scene blended_panels();
/// The same scene elsewhere.
Scene placed(Scene scene, dmat4 const& transform);

} // namespace gi::test
