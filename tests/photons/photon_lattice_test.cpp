// Photons in lattices against closed forms: furnaces, form factors, flux, thin walls.

#include "gi/core/error.h"
#include "tests/photons/traced_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

void turn(Scene& scene)
{
    glm::mat3 const by{{0.8f, 0.36f, 0.48f}, {-0.6f, 0.48f, 0.64f}, {0, -0.8f, 0.6f}};
    for (Mesh& mesh : scene.meshes)
        for (vec3& p : mesh.positions) p = by * p;
}

char const* name(IrradianceBy by) { return by == IrradianceBy::normals ? "normals" : "directions"; }

/// Where everything glows evenly with radiance 1 and reflects a half, light of one and more
/// scatterings has an irradiance of pi: closed rooms, and one with a closed box that stands on
/// its floor and another against its wall.
TEST(PhotonLattices, Furnace)
{
    char const* const shapes[] = {"box", "turned box", "sphere", "furnished box", "turned furnished box"};
    for (int shape = 0; shape < 5; ++shape) {
        Scene scene;
        int const wall = add_material(scene, glowing_wall(1, 0.5f));
        if (shape == 2)
            add_sphere(scene, vec3{0}, 1, 5, wall, false);
        else
            add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
        if (shape >= 3) {
            add_box(scene, {-0.5f, -1, -0.3f}, {0.1f, -0.2f, 0.4f}, wall, false);
            add_box(scene, {0.6f, -0.4f, -0.5f}, {1, 0.3f, 0.1f}, wall, false);
        }
        if (shape == 1 || shape == 4) turn(scene);
        TracedScene const traced(scene, 300000, 20);
        for (int const cells : {8, 32})
            for (IrradianceBy const by : {IrradianceBy::normals, IrradianceBy::directions}) {
                PhotonLattices const light =
                    lattices_of(traced, {.cells = {cells, cells, 32}, .smooth = {true, true, true}, .by = by});
                double mean = 0, off = 0, n = 0;
                for (std::size_t i = 0; i < traced.photons.size(); i += 37) {
                    Photon const& v = traced.photons[i];
                    double const e = double(luminance(light.irradiance(v.position, v.normal))) / kPiD;
                    mean += e;
                    off += std::abs(e - 1);
                    ++n;
                }
                fmt::print("{}, {} cells, by {}: mean {:.4f}, off by {:.4f}, hidden {:.2f} m^2, lost {:.1e}\n",
                           shapes[shape], cells, name(by), mean / n, off / n, light.hidden_m2(),
                           light.lost_w() / light.injected_w());
                EXPECT_EQ(light.lost_w(), 0);
                // Two surfaces in one plane, as where a box stands, are lit as one.
                EXPECT_NEAR(mean / n, 1, by == IrradianceBy::directions ? 0.16 : shape < 3 ? 0.01 : 0.04);
                EXPECT_LT(off / n, by == IrradianceBy::directions ? 0.16 : cells < 32 ? 0.045 : 0.07);
                // Hidden: the outside, and of the boxes and what they stand on a side each.
                EXPECT_NEAR(light.hidden_m2(),
                            shape == 2  ? 4 * kPiD
                            : shape < 3 ? 24
                                        : 25.68,
                            shape < 3 ? 0.05 : 0.3);
            }
    }
}

/// The same in nested lattices, for surfaces in the fine one, at its border and beyond.
TEST(PhotonLattices, NestedLatticesInAFurnace)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, glowing_wall(1, 0.5f)), true);
    TracedScene const traced(scene, 400000, 20);
    PhotonLattices light({.cells = {16, 16, 16}, .cascades = 3});
    light.place(traced.world, traced.visibility, {.camera = vec3{0.2f, -1, 0.3f}});
    light.update(traced.photons);
    ASSERT_EQ(light.cascades(Frequency::low).size(), 3u);
    double mean = 0, off = 0, n = 0;
    for (std::size_t i = 0; i < traced.photons.size(); i += 37) {
        Photon const& p = traced.photons[i];
        double const e = double(luminance(light.irradiance(p.position, p.normal))) / kPiD;
        mean += e;
        off += std::abs(e - 1);
        ++n;
    }
    fmt::print("nested: mean {:.4f}, off by {:.4f}\n", mean / n, off / n);
    EXPECT_NEAR(mean / n, 1, 0.01);
    EXPECT_LT(off / n, 0.05);
}

/// A floor in parallel light lights a wall at a right angle to it: the wall's irradiance against quadrature.
TEST(PhotonLattices, FormFactorOfTwoPlates)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.8f}));
    add_quad(scene, {-1, 0, 0}, {0, 0, 2}, {2, 0, 0}, matt); // y = 0, facing up
    add_quad(scene, {-1, 0, 0}, {2, 0, 0}, {0, 2, 0}, matt); // z = 0, facing +z
    Light sun;
    sun.type = LightType::directional;
    sun.direction = {0, -1, 0};
    sun.intensity = vec3{1};
    add_light(scene, sun);
    TracedScene const traced(scene, 2000000, 2);
    for (int const cells : {8, 16, 32})
        for (IrradianceBy const by : {IrradianceBy::normals, IrradianceBy::directions}) {
            PhotonLattices const light = lattices_of(traced, {.cells = {4, cells, 4}, .by = by});
            double off = 0, sum = 0, exact = 0, n = 0;
            for (int y = 3; y < 21; ++y)
                for (int x = 3; x < 21; ++x) {
                    dvec3 const at{-1 + (x + 0.5) / 12, 2 - (y + 0.5) / 12, 0};
                    constexpr int kParts = 80;
                    double truth = 0; // the floor's radiance is 0.8 / pi
                    for (int i = 0; i < kParts; ++i)
                        for (int k = 0; k < kParts; ++k) {
                            dvec3 const way = dvec3{-1 + (i + 0.5) * 2 / kParts, 0, (k + 0.5) * 2 / kParts} - at;
                            double const r2 = glm::dot(way, way);
                            truth += 0.8 / kPiD * way.z * -way.y / (r2 * r2) * (4.0 / (kParts * kParts));
                        }
                    double const found = double(light.irradiance(vec3(at), {0, 0, 1}).x);
                    off += std::abs(found / truth - 1);
                    sum += found;
                    exact += truth;
                    ++n;
                }
            fmt::print("{} cells, by {}: mean {:.4f}, off by {:.4f}\n", cells, name(by), sum / exact, off / n);
            EXPECT_NEAR(sum / exact, 1, cells == 8 ? 0.08 : 0.01);
            EXPECT_LT(off / n, cells == 8 ? 0.09 : 0.03);
        }
}

/// What the walls of a room receive is what the photons carry.
TEST(PhotonLattices, KeepFlux)
{
    for (bool const turned : {false, true}) {
        Scene scene;
        add_box(scene, {0, 0, 0}, {2, 2, 2}, add_material(scene, lambert(vec3{0.5f})), true);
        add_quad(scene, {0.5f, 1.5f, 0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{3})));
        if (turned) turn(scene);
        TracedScene const traced(scene, 200000, 10);
        for (IrradianceBy const by : {IrradianceBy::normals, IrradianceBy::directions}) {
            PhotonLattices const light = lattices_of(traced, {.by = by});
            double flux = 0;
            for (Surface const& s : traced.world.surfaces) {
                bool const both = s.is(Surface::kEmits); // of the walls, the inside
                vec3 const across = glm::cross(s.edge1, s.edge2), n = glm::normalize(across);
                int const parts = 60;
                for (int i = 0; i < parts; ++i)
                    for (int k = 0; k < parts; ++k) {
                        vec2 w{(float(i) + 0.5f) / parts, (float(k) + 0.5f) / parts};
                        if (w.x + w.y > 1) w = vec2{1} - w;
                        vec3 const at = s.corner + w.x * s.edge1 + w.y * s.edge2;
                        vec3 const e = light.irradiance(at, n) + (both ? light.irradiance(at, -n) : vec3{0});
                        flux += double(glm::dot(e, vec3{1}) * 0.5f * glm::length(across)) / (parts * parts);
                    }
            }
            fmt::print("{}by {}: {:.4f} of the flux\n", turned ? "turned, " : "", name(by),
                       flux / light.injected_w());
            EXPECT_NEAR(flux / light.injected_w(), 1, by == IrradianceBy::normals ? 0.01 : 0.08);
        }
    }
}

/// Where photons go by what they have met, and what is no scene.
TEST(PhotonLattices, PhotonsByFrequency)
{
    Scene scene;
    add_box(scene, {0, 0, 0}, {2, 2, 2}, add_material(scene, lambert(vec3{0.5f})), true);
    TracedScene traced(scene, 0, 1);
    EXPECT_TRUE(traced.photons.empty());
    Photon v{.position = {1, 0, 1},
             .normal = {0, 1, 0},
             .from = {0, 1, 0},
             .flux = vec3{1},
             .reflected = vec3{0.5f},
             .footprint = 1,
             .triangle = 0,
             .path = 0,
             .scatterings = 0,
             .by_delta = false,
             .front = true};
    for (int const side : {0, 1, 2, 3, 4, 5}) { // so that light has reached all sides
        Photon w = v;
        w.position = vec3{1};
        w.position[side / 2] = side % 2 != 0 ? 2 : 0;
        w.normal = vec3{0};
        w.normal[side / 2] = side % 2 != 0 ? -1 : 1;
        traced.photons.push_back(w);
    }
    std::size_t const direct = traced.photons.size();
    struct Case {
        int scatterings;
        bool by_delta;
        int found; ///< Frequency, or -1
    };
    for (Case const c : {Case{0, false, -1}, Case{0, true, 2}, Case{1, false, 1}, Case{1, true, 1},
                         Case{2, false, 0}, Case{7, true, 0}}) {
        traced.photons.resize(direct);
        v.scatterings = std::uint16_t(c.scatterings);
        v.by_delta = c.by_delta;
        traced.photons.push_back(v);
        PhotonLattices const light = lattices_of(traced, {});
        for (int f = 0; f < 3; ++f)
            EXPECT_EQ(light.irradiance(Frequency(f), v.position, v.normal).x > 0, f == c.found);
        EXPECT_NEAR(light.injected_w(), c.found < 0 ? 0 : 3, 1e-5);
        EXPECT_EQ(light.irradiance(v.position, {0, -1, 0}), vec3{0}); // the other side
        if (c.found >= 0) {
            Frequency const f = Frequency(c.found);
            EXPECT_GT(light.radiance(f, v.position, {0, 1, 0}).x, light.radiance(f, v.position, {1, 0, 0}).x);
        }
    }
}

TEST(PhotonLattices, NothingToShow)
{
    EXPECT_THROW(PhotonLattices({.cells = {2, 8, 8}}), InputError);
    EXPECT_THROW(PhotonLattices({.cells = {8, 8, 10000}}), InputError);
    PhotonLattices light({.cascades = 2});
    EXPECT_EQ(light.irradiance(vec3{0}, {0, 1, 0}), vec3{0});
    TracedScene const nothing(Scene{}, 100, 3);
    light.place(nothing.world, nothing.visibility, {.camera = vec3{0}});
    light.update(nothing.photons);
    EXPECT_EQ(light.radiance(vec3{0}, {0, 1, 0}), vec3{0});
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 0.5f}, add_material(scene, lambert(vec3{0.5f})));
    scene.meshes.back().triangles.resize(1);
    TracedScene triangle(scene, 100, 3);
    light.place(triangle.world, triangle.visibility, {.camera = vec3{1e9f}});
    light.update(triangle.photons);
    for (vec3 const at : {vec3{0.1f, 0, 0.1f}, vec3{1e20f}, vec3{-1e9f}}) {
        EXPECT_EQ(light.irradiance(at, {0, 1, 0}), vec3{0});
        EXPECT_EQ(light.radiance(at, {0, 1, 0}), vec3{0});
    }
    EXPECT_GT(PhotonLattices::bytes({}, triangle.world.bounds, surface_area(triangle.world)), 128u * 64u * 4u);
}

/// A wall without thickness between a bright and a dim half of a room.
TEST(PhotonLattices, ThinWall)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-2, 0, -1}, {2, 2, 1}, matt, true);
    add_quad(scene, {0, 0, -1}, {0, 2, 0}, {0, 0, 2}, matt);
    add_quad(scene, {-1.5f, 1.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{10})));
    add_quad(scene, {0.5f, 1.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{0.01f})));
    TracedScene const traced(scene, 400000, 10);
    for (int const cells : {16, 32})
        for (IrradianceBy const by : {IrradianceBy::normals, IrradianceBy::directions}) {
            PhotonLattices const light = lattices_of(traced, {.cells = {cells, cells, 4}, .by = by});
            double const bright = double(light.irradiance({0, 1, 0}, {-1, 0, 0}).x),
                         dim = double(light.irradiance({0, 1, 0}, {1, 0, 0}).x);
            fmt::print(
                "{} cells of {:.2f} m, by {}: {:.4f} of the light on the other side of the wall; on the floor "
                "at 0.05, 0.2, 0.5 m:",
                cells, light.cascades(Frequency::low)[0].frame.cell, name(by), dim / bright);
            EXPECT_LT(dim / bright, 0.01);
            EXPECT_LT(light.irradiance({0.5f, 0, 0}, {0, 1, 0}).x,
                      0.01f * light.irradiance({-0.5f, 0, 0}, {0, 1, 0}).x);
            for (float const x : {0.05f, 0.2f, 0.5f})
                fmt::print(" {:.4f}", double(light.irradiance({x, 0, 0}, {0, 1, 0}).x) /
                                          double(light.irradiance({-x, 0, 0}, {0, 1, 0}).x));
            fmt::print("\n");
        }
}

} // namespace
} // namespace gi::test
