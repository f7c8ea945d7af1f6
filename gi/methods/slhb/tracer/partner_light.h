#pragma once
// Light that one view of a moment takes over from another, as the two eyes of a person see nearly the same: a
// pixel whose surface point the partner sees too takes L1 and L2 of the partner's path there over the albedo. It
// is valid on matt surfaces, and on glossy ones whose lobe is wide against the angle between the views; mirrors,
// glass and narrow lobes, and what only one of the two sees, are traced. The noise of the two pictures is then
// the same on the same surfaces, as binocular fusion likes it. Error: light is sampled up to half a pixel aside.

#include "gi/filter/reused_light.h"
#include "gi/methods/slhb/lights/primary_map.h"
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

    /// Looks for the surface a path starts at; the partner's first surfaces must be there already.
    /// @param sample  gets what is its own (L0, albedo, normal, position, depth) where a partner is found
    /// @return the partner's pixel, else kOwnLight
    std::uint32_t find(PathStart const& start, PathSample& sample) const;

private:
    bool same_light(ShadingPoint const& at, std::uint32_t triangle, std::size_t pixel, vec3 direction) const;

    WorldView world_;
    PrimaryMap const& partner_;
    std::span<PathSample const> samples_;
    CameraRays partner_camera_, camera_;
};

/// Whether the paths of two pixels, each summed, met the same surface: neither lies on an edge of it.
/// @param pixel_m  size of a pixel there
bool same_surface(PixelSums const& a, PixelSums const& b, double pixel_m);

/// L1 and L2 of the partner's path, when that has ended, over its albedo and times the sample's own.
void take_light(PathSample const& partner, PathSample& sample);

} // namespace gi
