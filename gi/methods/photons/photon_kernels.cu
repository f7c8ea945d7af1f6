#include "gi/kernel/launch.cuh"
#include "gi/methods/photons/lattice_kernels.h"
#include "gi/methods/photons/light_propagation.h"
#include "gi/methods/photons/photon_cell_kernels.h"
#include "gi/methods/photons/propagation_kernels.h"
#include "gi/methods/photons/screen_volume_kernels.h"
#include "gi/methods/photons/splat_kernels.h"

namespace gi {

template void launch_device(char const*, std::size_t, FindFirstItems const&);
template void launch_device(char const*, std::size_t, SumItems<ReflectedLight, ShColor> const&);
template void launch_device(char const*, std::size_t, FindPhotonCells const&);
template void launch_device(char const*, std::size_t, SumItems<LatticePhoton, PhotonCell> const&);
template void launch_device(char const*, std::size_t, SmoothCells<PhotonCell> const&);
template void launch_device(char const*, std::size_t, GatherCells<PhotonCell> const&);
template void launch_device(char const*, std::size_t, FindScreenSurfaces const&);
template void launch_device(char const*, std::size_t, FindPhotonPixels const&);
template void launch_device(char const*, std::size_t, SumItems<ScreenPhoton, ShColor> const&);
template void launch_device(char const*, std::size_t, GatherScreen const&);
template void launch_device(char const*, std::size_t, ScaleFaces const&);
template void launch_device(char const*, std::size_t, OpenFaces const&);
template void launch_device(char const*, std::size_t, Propagate const&);

template void launch_device(char const*, std::size_t, CountTiles const&);
template void launch_device(char const*, std::size_t, FillTiles const&);
template void launch_device(char const*, std::size_t, SortTiles const&);

} // namespace gi

