#pragma once
// Procedurally generated scenes: for given parameters, the same on every machine.

#include "gi/scene/model/scene.h"

#include <cstdint>

namespace gi {

struct AtriumOptions {
    int bays = 5;                                         ///< number of arches along the gallery, >= 1
    double detail = 1;                                    ///< tessellation; 1 gives about 50,000 triangles
    bool figure = true;                                   ///< include the skinned walking figure
    double sun_elevation_deg = 42, sun_azimuth_deg = 130; ///< azimuth from -Z towards +X
};
Scene generate_atrium(AtriumOptions const& options);

/// Cornell box from its published measurements (Cornell University Program of Computer Graphics, box data of
/// 1998), in metres, with RGB reflectances and emission integrated from the published spectra.
Scene generate_cornell();

/// A room of 5 x 4.6 m with a mirror on the wall 1.6 m in front of the camera, which is at eye height (1.6 m);
/// behind it are two steps.
Scene generate_mirror();

/// A box of 1 m with a mirroring ring, a glass sphere and matt balls under a small lamp: caustics.
Scene generate_ring();

/// A skinned mannequin with a face, 1.77 m tall, standing on y = 0 and facing +Z, with the clip "walk", for use as
/// an avatar with `lightwell view --avatar`.
Scene generate_avatar();

/// `count` triangles (rounded to whole boxes of 12) as randomly rotated boxes on a grid
/// inside a closed room with an area light.
Scene generate_boxes(std::uint32_t triangles, std::uint64_t seed);

/// A displaced sphere of about `triangles` triangles in the same room.
Scene generate_sphere(std::uint32_t triangles, std::uint64_t seed);

} // namespace gi
