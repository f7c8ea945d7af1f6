#pragma once
// Why a picture under a sky is black: a dome or a room around the camera, as models made for rasterising viewers have.

#include "gi/scene/model/world.h"

#include <string>
#include <vector>

namespace viewer {

/// The meshes, at most three, behind which nearly all of the sky lies, seen from a place; empty = more is seen of it, or more
/// meshes hide it.
/// @param from_m  in the world's coordinates  @param threads  0 = all
std::vector<std::string> meshes_before_sky(gi::World const& world, gi::vec3 from_m, int threads = 0);

} // namespace viewer
