#pragma once
// Why a picture under a sky is black: a dome or a room around the camera, as models made for rasterising viewers have.

#include "gi/scene/model/world.h"

#include <string>

namespace viewer {

/// The mesh around a place behind which the whole sky lies; empty = the sky is seen from there, or no single mesh hides it.
/// @param from_m  in the world's coordinates  @param threads  0 = all
std::string mesh_before_sky(gi::World const& world, gi::vec3 from_m, int threads = 0);

} // namespace viewer
