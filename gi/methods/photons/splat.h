#pragma once
// Photons in lists by tiles of a screen, and the light of points seen there.

#include "gi/methods/photons/splat_kernels.h"
#include "gi/render/frame_renderer.h"

namespace gi {

/// @param world_origin  see World
ScreenMap screen_map(FrameView const& view, dvec3 world_origin);

class PhotonTiles {
public:
    /// @param photons, radii  must outlive it
    PhotonTiles(ScreenMap const& screen, View<Photon const> photons, View<float const> radii);
    TilesView view() const { return {screen_, ends_, list_, photons_, radii_}; }
    std::size_t entries() const { return list_.size(); }

private:
    ScreenMap screen_;
    View<Photon const> photons_;
    View<float const> radii_;
    std::vector<std::uint32_t> ends_, list_;
};

} // namespace gi
