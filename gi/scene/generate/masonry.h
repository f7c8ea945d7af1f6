#pragma once
// Building parts of generated scenes: arched walls, columns, barrel vaults.

#include "gi/scene/generate/builder.h"

namespace gi {

/// A wall in a plane of constant x with a round-headed opening; all lengths in m.
struct ArchWall {
    float x0, x1;       ///< thickness, x0 < x1
    float z0, z1;       ///< along the wall
    float y0, y1;       ///< foot and top
    float opening;      ///< width of the opening, in the middle
    float sill, spring; ///< heights of the opening's lower edge and of the start of its arch
    int segments;       ///< number of segments of the arch
};
void add_arch_wall(SceneBuilder& b, int material, ArchWall const& wall);

/// Adds a column: base, shaft with entasis, capital and abacus; the top of the abacus is at `height`.
void add_column(SceneBuilder& b, int material, vec3 foot, float height, float radius, int segments);

/// Adds a barrel vault along z between x0 < x1 and z0 < z1, visible from below.
void add_vault(SceneBuilder& b, int material, float x0, float x1, float z0, float z1, float spring, float rise,
               int across, int along);

} // namespace gi
