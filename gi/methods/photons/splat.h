#pragma once
// Photons in lists by tiles of a screen, and the light of points seen there.

#include "gi/core/progress.h"
#include "gi/methods/photons/splat_kernels.h"
#include "gi/render/frame_renderer.h"

namespace gi {

/// @param world_origin  see World
ScreenMap screen_map(FrameView const& view, dvec3 world_origin);

/// Entries that the lists of all tiles would have; each takes 4 bytes.
std::uint64_t tile_entries(ScreenMap const& screen, View<PhotonKernel const> kernels);

class PhotonTiles {
public:
    static constexpr std::uint64_t kMostEntries = std::uint64_t(1) << 28;

    /// Throws Interrupted. @param kernels, photons  must outlive it; tile_entries() of them at most kMostEntries
    PhotonTiles(ScreenMap const& screen, View<PhotonKernel const> kernels, View<Photon const> photons,
                BuildStop const& stop = BuildStop(nullptr));
    TilesView view() const { return {screen_, ends_, list_, kernels_, photons_}; }
    std::size_t entries() const { return list_.size(); }

private:
    ScreenMap screen_;
    View<PhotonKernel const> kernels_;
    View<Photon const> photons_;
    std::vector<std::uint32_t> ends_, list_;
};

/// For each view; none if together they would have more than PhotonTiles::kMostEntries. Throws Interrupted.
/// @param kernels, photons  must outlive them
std::vector<PhotonTiles> tiles_of_views(std::span<FrameView const> views, dvec3 world_origin,
                                        View<PhotonKernel const> kernels, View<Photon const> photons,
                                        BuildStop const& stop = BuildStop(nullptr));

} // namespace gi
