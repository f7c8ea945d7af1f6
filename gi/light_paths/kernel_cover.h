#pragma once
// The share of each photon's kernel that lies on surfaces. Beyond edges and around things smaller than a kernel,
// the rest of the light would be lost; it is given to the surfaces that the kernel covers.

#include "gi/light_paths/photon_map.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/path_sample.h"

namespace gi {

/// Share of each kernel's weight that lies on surfaces, above 0, by exact rays onto its disk:
/// a few, and more if some of them miss the surface.
std::vector<float> covered_shares(WorldView const& world, ExactVisibility const& visibility,
                                  std::span<Photon const> photons, std::span<PhotonKernel const> kernels,
                                  BuildStop const& stop, PathCounts& counts);

} // namespace gi
