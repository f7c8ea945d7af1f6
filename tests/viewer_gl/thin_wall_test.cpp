// Light does not come through a wall of 5 cm: a dark room beside a bright one, lit from cells of space and from pictures of light.

#include "gi/scene/motion/moving_world.h"
#include "gi/surfaces/light_cells.h"
#include "gi/surfaces/seen_surfaces.h"
#include "tests/support/scenes.h"
#include "tests/viewer_gl/surfaceless.h"
#include "viewer/devices/gl/surface_renderer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <numbers>

namespace viewer::test::thin_wall {
namespace {

using gi::dvec3, gi::vec3;

constexpr glm::ivec2 kSize{150, 110}, kLight{96, 72};
constexpr float kHalf_m = 0.025f; ///< of the wall between x < 0, where light is 1, and x > 0, where it is 0

/// @param aside_m  of the wall from the border of cells at x = 0
std::shared_ptr<gi::Scene const> two_rooms(float aside_m)
{
    gi::Scene scene;
    int const white = gi::test::add_material(scene, gi::test::lambert(vec3{1}));
    gi::test::add_box(scene, {aside_m - 4, 0, -3}, {aside_m + 4, 2.5f, 3}, white, true);
    gi::test::add_box(scene, {aside_m - kHalf_m, -0.1f, -3.1f}, {aside_m + kHalf_m, 2.6f, 3.1f}, white,
                      false); // no cracks at its borders
    return std::make_shared<gi::Scene const>(std::move(scene));
}

class ThinWall : public Surfaceless {
protected:
    /// What a camera sees, whose light is 1 beyond the wall and 0 here.
    gi::LightPicture light_seen(gi::Camera const& camera, glm::ivec2 size) const
    {
        gi::World const& w = world->world();
        gi::SeenSurfaces seen(w, 0);
        gi::CameraRays const rays = gi::camera_rays(camera, size.x, size.y, w.origin);
        seen.look(rays, size.x, size.y);
        gi::Picture p{size.x, size.y, {}, {}};
        for (char const* name : {"L1", "L2", "albedo", "normal", "position"}) p.add(name, 3);
        std::vector<gi::SeenSurface> row(std::size_t(size.x));
        for (int y = 0; y < size.y; ++y) {
            seen.row(y, row);
            for (int x = 0; x < size.x; ++x) {
                gi::SeenSurface const& s = row[std::size_t(x)];
                if (!(s.depth > 0)) continue;
                auto const i = std::size_t(3 * (y * size.x + x));
                float const light = s.position.x + float(w.origin.x) < aside ? 1.0f : 0.0f;
                for (std::size_t c = 0; c < 3; ++c) {
                    p.find("L1")->data[i + c] = light * s.albedo[int(c)];
                    p.find("albedo")->data[i + c] = s.albedo[int(c)];
                    p.find("normal")->data[i + c] = s.normal[int(c)];
                    p.find("position")->data[i + c] = float(double(s.position[int(c)]) + w.origin[int(c)]);
                }
            }
        }
        return gi::light_picture(p, camera, std::size_t(size.x * size.y));
    }
    /// A picture of light of a frame of a session, and what its paths into all directions find.
    void learn(dvec3 from, dvec3 at)
    {
        from.x += double(aside);
        at.x += double(aside);
        constexpr double k = std::numbers::inv_sqrt3;
        static constexpr std::array<dvec3, 4> kForward{dvec3{k, k, k}, {-k, -k, k}, {-k, k, -k}, {k, -k, -k}};
        newest = light_seen(gi::look_at(from, at, 60), kLight);
        cells->learn(newest, 1u << 13, world->world().origin);
        gi::LightPicture const around = light_seen(gi::look_at(from, from + kForward[frame++ % 4], 115), {56, 56});
        cells->learn(around, around.texels.size(), world->world().origin);
    }
    struct Leak {
        double mean = 0, most = 0, above = 0; ///< above: share of more than 1 %
    };
    /// Along the wall, near it. @param with_pictures  the newest picture of light counts too
    Leak seen_beside_the_wall(bool with_pictures)
    {
        Leak leak;
        double n = 0;
        SurfaceRenderer renderer;
        renderer.take(gi::shown_scene(world, {}, nullptr));
        renderer.take(cells->table());
        gi::LightPicture nothing = light_seen(gi::look_at({2.0 + double(aside), 1.2, 0}, {3, 1.2, 0}, 20), {8, 8});
        renderer.add_light({{0, 0, with_pictures ? &newest : &nothing}});
        while (!renderer.prepare(1)) {
        }
        PictureTexture picture;
        picture.upload(kSize, std::vector<float>(std::size_t(3 * kSize.x * kSize.y)),
                       std::vector<float>(std::size_t(kSize.x * kSize.y)));
        for (double z = -2.5; z < 2.6; z += 1)
            for (dvec3 const to :
                 {dvec3(0, 0, z + 1), dvec3(0, 0.4, z - 1), dvec3(0, 2.5, z + 0.5), dvec3(1, 0, z)}) {
                gi::Camera const camera = gi::look_at({0.35 + double(aside), 1.5, z}, to + dvec3(aside, 0, 0), 75);
                ShownPicture const out = renderer.draw(0, 0, camera, kSize, picture, camera);
                std::vector<float> rgb(std::size_t(3 * kSize.x * kSize.y));
                glPixelStorei(GL_PACK_ALIGNMENT, 4);
                glGetTextureImage(out.texture, 0, GL_RGB, GL_FLOAT, GLsizei(rgb.size() * sizeof(float)),
                                  rgb.data());
                for (float const v : rgb) {
                    leak.mean += double(v);
                    leak.above += v > 0.01f;
                    leak.most = std::max(leak.most, double(v));
                    n += 1;
                }
            }
        leak.mean /= n;
        leak.above /= n;
        return leak;
    }

    void begin(float aside_m)
    {
        aside = aside_m;
        world = std::make_shared<gi::MovingWorld>(two_rooms(aside), 0.0, report);
        cells.emplace(world->world().bounds.radius());
        frame = 0;
    }

    std::shared_ptr<gi::MovingWorld> world;
    std::optional<gi::LightCells> cells;
    gi::LightPicture newest;
    std::uint64_t frame = 0;
    float aside = 0;
};

TEST_F(ThinWall, IsDarkBehindIt)
{
    for (float const aside_m : {0.0f, 0.054f}) { // the wall between cells; within them
        SCOPED_TRACE(aside_m);
        begin(aside_m);
        // A walk through the bright room, then through the dark one.
        for (int k = 0; k < 24; ++k) learn({-2 + 0.05 * k, 1.6, -2 + 0.15 * k}, {0, 0.8, 0.1 * k - 1.5});
        for (int k = 0; k < 30; ++k) learn({1.5, 1.6, 1 - 0.08 * k}, {0, 0.8, 1 - 0.12 * k});
        for (bool const with_pictures : {false, true}) {
            Leak const leak = seen_beside_the_wall(with_pictures);
            fmt::print("{}: mean {:.5f}, {:.3f} % of the values above 0.01, most {:.4f}\n",
                       with_pictures ? "newest picture and cells" : "cells alone", leak.mean, 100 * leak.above,
                       leak.most);
            EXPECT_LE(leak.mean, 0.01);
            EXPECT_LE(leak.most, aside_m == 0 ? 0.01 : 0.25); // wanted: 0.01; see docs/display-passes.md
            EXPECT_LE(leak.above, 0.005);
        }
    }
}

} // namespace
} // namespace viewer::test::thin_wall
