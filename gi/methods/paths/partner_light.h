#pragma once
// Light that one view reuses from another view of the same moment, because two eyes see nearly the same: a pixel
// whose surface point is also visible to the partner takes L1 and L2 over albedo from the partner's path there.
// Valid on diffuse surfaces, and on glossy ones whose lobe is wide compared with the angle between the views;
// mirrors, glass, narrow lobes and surfaces seen by one view only are traced. The noise is then the same on the
// same surfaces in both pictures, which helps binocular fusion. Error: light is sampled up to half a pixel away.

#include "gi/filter/reused_light.h"
#include "gi/methods/paths/primary_map.h"
#include "gi/render/accumulator.h"

namespace gi {

class PartnerLight {
public:
    PartnerLight(World const& world, PrimaryMap const& partner, std::span<PathSample const> partner_samples,
                 CameraRays const& partner_camera, CameraRays const& camera)
        : world_(view(world)),
          partner_(partner),
          samples_(partner_samples),
          partner_camera_(partner_camera),
          camera_(camera)
    {
    }

    /// Finds the partner's pixel that shows the surface a path starts at; the partner's
    /// first surfaces must be ready.
    /// @param sample  receives the pixel's own values (L0, albedo, normal, position,
    ///   depth) if a partner pixel is found
    /// @return the partner's pixel, else kOwnLight
    std::uint32_t find(PathStart const& start, PathSample& sample) const;

private:
    bool same_light(ShadingPoint const& at, std::uint32_t triangle, std::size_t pixel, vec3 direction) const;

    WorldView world_;
    PrimaryMap const& partner_;
    std::span<PathSample const> samples_;
    CameraRays partner_camera_, camera_;
};

/// True if all paths of two pixels (given as sums) hit the same surface, so that neither pixel lies on an edge.
/// @param pixel_m  size of a pixel at the surface
bool same_surface(PixelMeans const& a, PixelMeans const& b, double pixel_m);

/// Sets L1 and L2 of the sample from the partner's completed path: divided by its albedo, times the sample's own.
void take_light(PathSample const& partner, PathSample& sample);

} // namespace gi
