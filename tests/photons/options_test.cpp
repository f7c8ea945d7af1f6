// What pictures say about how they were made, and the checkpoints from which they continue.

#include "gi/hit_buffers/settings.h"
#include "gi/light_paths/options.h"
#include "gi/methods/sh_grid/settings.h"
#include "gi/methods/sh_grid/sh_grid.h"
#include "tests/photons/photon_methods.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

bool says(std::string const& options, char const* words) { return options.find(words) != std::string::npos; }

/// Look-ups read options of hit buffers: they are in the recorded options and decide about checkpoints.
TEST(PhotonOptions, OfHitBuffers)
{
    World const world = world_of(room_with_mirror());
    std::vector<PhotonMethod> methods(std::begin(kPhotonMethods), std::end(kPhotonMethods));
    methods.push_back({"sh_grid", render_sh_grid, start_sh_grid_frames});
    for (PhotonMethod const& m : methods) {
        if (m.render == render_multi_image) continue; // by impostors
        RenderSettings s = small_photon_picture(8, 256);
        s.of<ShGridSettings>().voxels = 16;
        s.of<SlhbSettings>().directions = "icosahedron:20";
        s.of<SlhbSettings>().resolution = 64;
        RenderSettings other = s;
        other.of<SlhbSettings>().directions = "icosahedron:80";
        for (PhotonRays const rays : {PhotonRays::look_ups, PhotonRays::exact}) {
            s.of<PhotonSettings>().rays = other.of<PhotonSettings>().rays = rays;
            bool const look_ups = rays == PhotonRays::look_ups;
            Report report;
            std::string const options = m.render(world, in_the_room(), s, {}, {}, report).options;
            EXPECT_EQ(says(options, "--directions icosahedron:20 --hit-buffer 64"), look_ups)
                << m.name << ": " << options;
        }
    }
}

/// Recorded options can be pasted into a shell.
TEST(PhotonOptions, AreQuoted)
{
    RenderSettings s;
    s.of<PhotonSettings>().impostor_places = "0,1.5,0;4,1.5,0";
    EXPECT_EQ(changed_options(photon_options(), s, {}), "--impostor-places '0,1.5,0;4,1.5,0'");
}

} // namespace
} // namespace gi::test
