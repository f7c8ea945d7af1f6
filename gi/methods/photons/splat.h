#pragma once
// Photons in lists by tiles of a screen, and the light of points seen there.

#include "gi/methods/photons/splat_kernels.h"
#include "gi/render/frame_renderer.h"

namespace gi {

/// @param world_origin  see World
ScreenMap screen_map(FrameView const& view, dvec3 world_origin);

class PhotonTiles {
public:
    /// @param kernels, photons  must outlive it
    PhotonTiles(ScreenMap const& screen, View<PhotonKernel const> kernels, View<Photon const> photons);
    TilesView view() const { return {screen_, ends_, list_, kernels_, photons_}; }
    std::size_t entries() const { return list_.size(); }

private:
    ScreenMap screen_;
    View<PhotonKernel const> kernels_;
    View<Photon const> photons_;
    std::vector<std::uint32_t> ends_, list_;
};

} // namespace gi
