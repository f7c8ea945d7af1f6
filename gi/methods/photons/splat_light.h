#pragma once
// The light of photons at the points of ray trees.

#include "gi/methods/photons/splat.h"
#include "gi/methods/whitted/tree_tracer.h"

namespace gi {

/// Points on a screen take photons from the lists of its tiles, others (seen in mirrors, or behind the border)
/// from the map.
class SplatLight : public SurfaceLight {
public:
    SplatLight(std::vector<PhotonTiles> const& screens, PhotonMap const& map, PhotonMap const* caustics)
        : screens_(screens), map_(map), caustics_(caustics)
    {
    }
    void indirect(std::span<TreePoint> points, std::span<vec3> out, PathCounts&) const override;

private:
    struct Place {
        std::uint64_t block;
        std::uint32_t point, screen, tile;
    };
    std::optional<Place> find_place(TreePoint const& p, std::uint32_t i) const;
    void splat_block(std::span<TreePoint const> points, std::span<Place const> places, std::span<vec3> out) const;

    std::vector<PhotonTiles> const& screens_;
    PhotonMap const& map_;
    PhotonMap const* caustics_;
};

} // namespace gi
