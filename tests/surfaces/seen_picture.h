#pragma once
// A view of the surfaces of a world, and the same by exact rays.

#include "gi/surfaces/seen_surfaces.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {

struct SeenPicture {
    int width = 0, height = 0;
    std::vector<SeenSurface> pixels;

    SeenSurface const& at(int x, int y) const
    {
        return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
    SeenSurface const& middle() const { return at(width / 2, height / 2); }
};

inline SeenPicture look(SeenSurfaces& seen, CameraRays const& rays, int width, int height,
                        SeenSurfaces::Lights lights = SeenSurfaces::Lights::none)
{
    SeenPicture p{width, height, std::vector<SeenSurface>(std::size_t(width) * std::size_t(height))};
    seen.look(rays, width, height, lights);
    for (int y = 0; y < height; ++y)
        seen.row(y, std::span(p.pixels).subspan(std::size_t(y) * std::size_t(width), std::size_t(width)));
    return p;
}

inline SeenPicture look(World const& world, Camera const& camera, int width, int height,
                        SeenSurfaces::Lights lights = SeenSurfaces::Lights::none)
{
    SeenSurfaces seen(world, 0);
    return look(seen, camera_rays(camera, width, height, world.origin), width, height, lights);
}

inline bool all_finite(SeenSurface const& s)
{
    bool finite = std::isfinite(s.depth);
    for (vec3 const v : {s.albedo, s.normal, s.position, s.emitted, s.moved, s.direct})
        for (int c = 0; c < 3; ++c) finite &= std::isfinite(v[c]);
    return finite;
}

inline void expect_near(vec3 a, vec3 b, float most, char const* what)
{
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], most) << what << ", channel " << c;
}

} // namespace gi::test
