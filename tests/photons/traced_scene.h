#pragma once
// Scenes with their photons, and lattices of these.

#include "gi/methods/photons/photon_lattice.h"
#include "tests/support/scenes.h"

namespace gi::test {

struct TracedScene {
    World world;
    ExactVisibility visibility;
    std::vector<Photon> photons;

    TracedScene(Scene scene, std::uint32_t paths, int bounces)
        : world(world_of(std::move(scene))), visibility(world, false, 0)
    {
        PathCounts counts;
        LightPaths settings;
        settings.count = paths;
        settings.bounces = bounces;
        for (LightVertex const& v :
             trace_light_paths(view(world), world.bounds, ExactPathRays(visibility), settings, counts))
            photons.push_back(to_photon(v));
    }
};

inline PhotonLattices lattices_of(TracedScene const& scene, PhotonLatticeSettings const& settings)
{
    PhotonLattices out(settings);
    out.place(scene.world, scene.visibility, {.camera = vec3{0}});
    out.update(scene.photons);
    out.update_caustics(scene.photons);
    return out;
}

inline Material glowing_wall(float radiance, float albedo)
{
    Material m = emitter(vec3{radiance}, true);
    m.base_color = vec3{albedo};
    return m;
}

/// Irradiance at some photons by what it should be: mean, and mean of the errors.
struct RelativeIrradiance {
    double mean = 0, off = 0;
};
template <class Which>
RelativeIrradiance relative_irradiance(PhotonLattices const& light, std::span<Photon const> photons, double truth,
                                       Which const& which)
{
    RelativeIrradiance out;
    double n = 0;
    for (std::size_t i = 0; i < photons.size(); i += 7) {
        if (!which(photons[i])) continue;
        double const e = double(luminance(light.irradiance(photons[i].position, photons[i].normal))) / truth;
        out.mean += e;
        out.off += std::abs(e - 1);
        ++n;
    }
    out.mean /= n;
    out.off /= n;
    return out;
}

} // namespace gi::test
