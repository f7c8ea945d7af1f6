// Lattices as multi_image uses them: gathering, nested about a focus, with moving triangles;
// and the formula of the paper.

#include "tests/photons/traced_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// L_j = A C_0^2 / (4 N) Phi (theta . n)+ f_r (Fei and Wang), summed over the photons of a texel, in a box of 2 m
/// that glows evenly: light of one and more scatterings has irradiance pi, so a wall of albedo rho reflects rho.
/// Photons of a texel with area a of walls carry pi a, and their mean cosine is 2/3. So the sum is rho A C_0^2 a /
/// (6 N), right for C_0 = sqrt(6 N / (A a)) alone, which differs with the texels' size and the area in each. If
/// Phi is meant as a photon's power times N, the same without N.
TEST(LightGatheringVolume, TheFormulaOfThePaper)
{
    constexpr std::uint32_t kPaths = 400000;
    constexpr double kArea = 24, kAlbedo = 0.5;
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, glowing_wall(1, float(kAlbedo))), true);
    TracedScene const traced(scene, kPaths, 20);
    for (int const texels : {4, 16}) { // across a wall
        double floor = 0;
        for (Photon const& p : traced.photons)
            if (p.scatterings > 0 && p.normal.y > 0.9f)
                floor += kArea / (4.0 * kPaths) * double(luminance(p.flux)) *
                         double(std::max(glm::dot(p.from, p.normal), 0.0f)) * kAlbedo / kPiD;
        double const radiance = floor / (texels * texels), a = 4.0 / (texels * texels);
        double const right = std::sqrt(kAlbedo / radiance);
        fmt::print(
            "{} texels: radiance for C_0 = 1: {:.3e} of the right one, for powers times N {:.3f}; right for "
            "C_0 = {:.1f} ({:.2f})\n",
            texels, radiance / kAlbedo, radiance / kAlbedo * kPaths, right, right / std::sqrt(kPaths));
        EXPECT_NEAR(radiance / kAlbedo / (kArea * a / (6.0 * kPaths)), 1, 0.02);
        EXPECT_NEAR(right / std::sqrt(6.0 * kPaths / (kArea * a)), 1, 0.01);
        // Divided by the area in each cell it is right for both.
        for (int const gathers : {0, 1, 8}) {
            PhotonLattices const light =
                lattices_of(traced, {.cells = {texels, texels, 4}, .smooth = {}, .gathers = gathers});
            auto const found =
                relative_irradiance(light, traced.photons, kPiD, [](Photon const&) { return true; });
            fmt::print("  by area, {} gathers: mean {:.4f}, off by {:.4f}\n", gathers, found.mean, found.off);
            EXPECT_NEAR(found.mean, 1, gathers == 0 ? 0.015 : 0.01);
            EXPECT_LT(found.off, gathers == 0 ? 0.06 : 0.05);
        }
    }
}

/// Gathering makes light even, and keeps what surfaces get in all.
TEST(LightGatheringVolume, GatheringKeepsFlux)
{
    Scene scene;
    add_box(scene, {0, 0, 0}, {2, 2, 2}, add_material(scene, lambert(vec3{0.5f})), true);
    add_quad(scene, {0.5f, 1.5f, 0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{3})));
    TracedScene const traced(scene, 100000, 10);
    double noise = 0, whole = 0;
    for (int const gathers : {0, 2, 16}) {
        PhotonLattices const light = lattices_of(traced, {.cells = {32, 32, 4}, .smooth = {}, .gathers = gathers});
        double flux = 0, squares = 0;
        for (Frequency const f : {Frequency::low, Frequency::middle})
            for (PhotonCell const& c : light.cascades(f)[0].cells.values) {
                flux += double(glm::dot(c.received.integral(), vec3{1}));
                squares += square(double(c.received.c[0].x));
            }
        EXPECT_NEAR(flux / light.injected_w(), 1, 1e-4);
        if (gathers > 0) {
            EXPECT_LT(squares, 0.99 * noise);
            EXPECT_NEAR(flux / whole, 1, 1e-4);
        }
        noise = squares;
        whole = flux;
    }
}

/// A dim room of 2 m with walls of 0.1 m in a bright hall of 16 m. Coarse cells mix the two;
/// lattices about the room do not.
TEST(LightGatheringVolume, ARoomInALargeWorld)
{
    Scene scene;
    Material bright = glowing_wall(1, 0.5f), dim = glowing_wall(0.5f, 0.5f);
    bright.double_sided = dim.double_sided = false; // nothing shines between the walls
    add_box(scene, vec3{-8}, vec3{8}, add_material(scene, bright), true);
    add_box(scene, vec3{-1}, vec3{1}, add_material(scene, dim), true);
    add_box(scene, vec3{-1.1f}, vec3{1.1f}, add_material(scene, lambert(vec3{0.5f})), false);
    TracedScene const traced(scene, 1000000, 12);
    auto const inside = [](Photon const& p) { return max_component(glm::abs(p.position)) < 1.01f; };
    auto const outside = [](Photon const& p) { return max_component(glm::abs(p.position)) > 1.05f; };
    PhotonLattices light({.cells = {16, 16, 4}, .smooth = {}, .gathers = 1});
    RelativeIrradiance of_room[2], of_hall[2];
    for (bool const focus : {false, true}) {
        LatticePlace place;
        if (focus) place.focus = {vec3{-1.2f}, vec3{1.2f}};
        light.place(traced.world, traced.visibility, place);
        light.update(traced.photons);
        EXPECT_EQ(light.cascades(Frequency::low).size(), focus ? 3u : 1u);
        of_room[focus] = relative_irradiance(light, traced.photons, 0.5 * kPiD, inside);
        of_hall[focus] = relative_irradiance(light, traced.photons, kPiD, outside);
        fmt::print("{}: room: mean {:.3f}, off by {:.3f}; hall: mean {:.3f}\n", focus ? "focus" : "no focus",
                   of_room[focus].mean, of_room[focus].off, of_hall[focus].mean);
    }
    EXPECT_NEAR(of_room[true].mean, 1, 0.12); // at its edges cells hold both
    EXPECT_LT(of_room[true].off, 0.14);
    EXPECT_LT(of_room[true].off, 0.5 * of_room[false].off);
    EXPECT_NEAR(of_hall[true].mean, 1, 0.03);
}

/// When only a box has moved, the room's part is kept; light equals that of newly placed lattices.
TEST(LightGatheringVolume, AMovingBox)
{
    auto const room_with_box_at = [](float x) {
        Scene scene;
        int const wall = add_material(scene, glowing_wall(1, 0.5f));
        add_box(scene, vec3{-1}, vec3{1}, wall, true);
        add_box(scene, {x, -0.6f, -0.2f}, {x + 0.4f, -0.2f, 0.2f}, wall, false);
        return scene;
    };
    constexpr std::size_t kFirstMoving = 12;
    TracedScene const before(room_with_box_at(-0.7f), 200000, 12), after(room_with_box_at(0.3f), 200000, 12);
    PhotonLattices moved({.cells = {16, 16, 4}}), anew({.cells = {16, 16, 4}});
    moved.place(before.world, before.visibility, {.first_moving = kFirstMoving});
    moved.update(before.photons);
    moved.place(after.world, after.visibility, {.first_moving = kFirstMoving, .only_moved = true});
    moved.update(after.photons);
    anew.place(after.world, after.visibility, {});
    anew.update(after.photons);
    for (Frequency const f : {Frequency::low, Frequency::middle}) {
        EXPECT_EQ(moved.cascades(f)[0].cells.values.size(), anew.cascades(f)[0].cells.values.size());
        EXPECT_EQ(moved.cascades(f)[0].pieces.size(), anew.cascades(f)[0].pieces.size());
    }
    auto const of_box = [](Photon const& p) { return p.triangle >= kFirstMoving; };
    auto const of_room = [](Photon const& p) { return p.triangle < kFirstMoving; };
    auto const box = relative_irradiance(moved, after.photons, kPiD, of_box),
               room = relative_irradiance(moved, after.photons, kPiD, of_room),
               box_anew = relative_irradiance(anew, after.photons, kPiD, of_box);
    fmt::print("box: mean {:.4f}, anew {:.4f}; room: mean {:.4f}\n", box.mean, box_anew.mean, room.mean);
    EXPECT_NEAR(box.mean, box_anew.mean, 0.01);
    EXPECT_NEAR(box.mean, 1, 0.05);
    EXPECT_NEAR(room.mean, 1, 0.02);
    // Where the box was, nothing is left.
    EXPECT_EQ(moved.irradiance({-0.5f, -0.2f, 0}, {0, 1, 0}), vec3{0});
    EXPECT_GT(moved.irradiance({0.5f, -0.2f, 0}, {0, 1, 0}).x, 1);
}

/// A crumb of 2 mm in cells of 0.25 m: what it gets counts as spread over a hundredth of a cell's face.
TEST(LightGatheringVolume, HardlyAnyArea)
{
    Scene scene;
    int const wall = add_material(scene, glowing_wall(1, 0.5f));
    add_box(scene, vec3{-2}, vec3{2}, wall, true);
    add_quad(scene, {0.1f, 0.1f, 0.1f}, {0.002f, 0, 0}, {0, 0, -0.002f}, wall);
    TracedScene traced(scene, 20000, 6);
    auto const on_crumb = [&](Photon const& p) { return p.triangle >= 12; };
    std::erase_if(traced.photons, on_crumb);
    Photon stray = traced.photons.front();
    stray.position = {0.101f, 0.1f, 0.099f};
    stray.normal = stray.from = {0, 1, 0};
    stray.flux = vec3{1};
    stray.scatterings = 2;
    stray.triangle = 12;
    stray.front = true;
    traced.photons.push_back(stray);
    PhotonLattices const light = lattices_of(traced, {.cells = {16, 16, 4}, .smooth = {}});
    float const cell = light.cascades(Frequency::low)[0].frame.cell;
    float const found = light.irradiance(Frequency::low, stray.position, stray.normal).x;
    fmt::print("a stray photon of 1 W: {:.0f} W/m^2, {:.3f} W left out\n", found, light.dimmed_w());
    EXPECT_GT(found, 0);
    EXPECT_LT(found, 2 / (PhotonLatticeSettings::kLeastArea * cell * cell)); // 4e-6 m^2 would give 250 kW/m^2
    EXPECT_NEAR(light.dimmed_w(), 3, 0.1);
}

} // namespace
} // namespace gi::test
