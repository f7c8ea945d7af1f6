// Motion vectors of the reference path tracer against those of slhb.

#include "gi/light_paths/settings.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/registry.h"
#include "gi/methods/sh_grid/settings.h"
#include "gi/methods/vpl/settings.h"
#include "tests/slhb/slhb_render.h"
#include "gi/methods/paths/motion.h"
#include "gi/scene/generate/figure.h"
#include "gi/scene/generate/generate.h"
#include "tests/support/scenes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr double kStep_s = 0.1;

std::shared_ptr<Scene const> room_with_walker()
{
    Scene scene = generate_sphere(2000, 0);
    add_figure(scene, glm::translate(dmat4(1), dvec3{2.5, 1.5, 0}), 0.3);
    return std::make_shared<Scene const>(std::move(scene));
}

RenderSettings one_path()
{
    RenderSettings s;
    s.width = s.height = 96;
    s.paths = 1;
    s.bounces = 1;
    s.of<SlhbSettings>().schedule = Schedule::streamed;
    s.of<SlhbSettings>().resolution = 48;
    s.of<PhotonSettings>().paths = s.of<PhotonSettings>().caustic_paths = 1024; // motion does not depend on light
    s.of<ShGridSettings>().voxels = 16;
    s.of<VirtualLightSettings>().light_paths = 16;
    return s;
}

Camera a_step_aside(Camera camera)
{
    camera.world_from_camera = camera.world_from_camera * glm::translate(dmat4(1), dvec3{0.07, 0.02, 0});
    return camera;
}

/// The same rays, met by a raster and by Embree.
TEST(MotionVectors, OfExactHitsAreThoseOfTheRaster)
{
    Report report;
    MovingWorld moving(room_with_walker(), 0, report);
    World const& world = moving.world();
    RenderSettings const s = one_path();
    Camera const camera = world.cameras.at(0);
    CameraRays const before = camera_rays(camera, s.width, s.height, world.origin);
    CameraRays const now = camera_rays(a_step_aside(camera), s.width, s.height, world.origin);
    EarlierCorners const earlier{world.static_triangles, corners_of(world, world.static_triangles)};
    moving.advance(kStep_s);
    TriangleSoup const soup = make_soup(world);
    CutOuts const cut_outs(world);
    PrimaryMap map(soup, cut_outs, s, s.width, s.height);
    map.refresh(now, near_plane(world.bounds), 0);
    Picture expected{s.width, s.height, {}, {}}, found = expected;
    add_motion(map, soup, now, before, earlier, expected);

    std::size_t const pixels = expected.pixels(), width = std::size_t(s.width);
    std::vector<PathStart> starts;
    map.hits(0, pixels, starts);
    std::vector<RayQuery> queries(pixels);
    std::vector<Hit> hits(pixels);
    for (std::size_t i = 0; i < pixels; ++i) queries[i].ray = starts[i].ray;
    ExactVisibility(world, false, 0, world.static_triangles).nearest(queries, hits);
    auto const seen = [&](std::size_t y, std::span<SeenPoint> row) {
        for (std::size_t x = 0; x < width; ++x) {
            Hit const& h = hits[y * width + x];
            uvec3 const v = world.triangles[h.triangle];
            Corners const corners{world.positions[v.x], world.positions[v.y], world.positions[v.z]};
            row[x] = {h.triangle, h.barycentric, point_on(corners, h.barycentric)};
        }
    };
    add_motion(seen, now, before, earlier, found);

    std::size_t same = 0, moving_pixels = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (starts[i].triangle != hits[i].triangle) continue; // an edge
        ++same;
        moving_pixels += hits[i].triangle >= world.static_triangles;
        vec3 const a = rgb(*expected.find("motion"), i), b = rgb(*found.find("motion"), i);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 2e-3f) << i;
    }
    EXPECT_GT(same, pixels * 99 / 100);
    EXPECT_GT(moving_pixels, 50u);
}

/// The second frame of a method, a step later, seen from a step aside.
Picture second_frame(StartFrames start, std::shared_ptr<Scene const> const& scene, bool camera_moves)
{
    Report report;
    MovingWorld moving(scene, 0, report);
    Camera const camera = moving.world().cameras.at(0);
    auto const frames = start(moving, camera, one_path(), report);
    frames->frame(camera, {}, {});
    frames->changed(moving.advance(kStep_s));
    return frames->frame(camera_moves ? a_step_aside(camera) : camera, {}, {}).picture;
}

/// Paths of the two methods go through different points of a pixel: the motion of one lies within the range
/// of motion of the other's surrounding pixels.
TEST(MotionVectors, OfTheReferenceAreThoseOfSlhb)
{
    auto const scene = room_with_walker();
    for (bool const camera_moves : {false, true}) {
        Picture const slhb = second_frame(start_slhb_frames, scene, camera_moves),
                      reference = second_frame(start_reference_frames, scene, camera_moves);
        ASSERT_NE(reference.find("motion"), nullptr);
        std::size_t within = 0, all = 0, moves = 0;
        for (int y = 1; y + 1 < slhb.height; ++y)
            for (int x = 1; x + 1 < slhb.width; ++x) {
                auto const at = [&](Picture const& p, int i, int j) {
                    return rgb(*p.find("motion"), std::size_t(j) * std::size_t(p.width) + std::size_t(i));
                };
                vec3 low{1e9f}, high{-1e9f};
                for (int j = y - 1; j <= y + 1; ++j)
                    for (int i = x - 1; i <= x + 1; ++i) {
                        low = glm::min(low, at(slhb, i, j));
                        high = glm::max(high, at(slhb, i, j));
                    }
                vec3 const m = at(reference, x, y);
                bool inside = true;
                for (int c = 0; c < 3; ++c) inside &= m[c] >= low[c] - 0.02f && m[c] <= high[c] + 0.02f;
                ++all;
                within += inside;
                moves += m.x != 0 || m.y != 0;
            }
        EXPECT_GT(within, all * 98 / 100) << camera_moves;
        EXPECT_GT(moves, camera_moves ? all * 99 / 100 : 50u);
        if (camera_moves) continue;
        EXPECT_LT(moves, all / 2); // what stands still has 0, 0 exactly
    }
}

/// Methods whose paths start with the same rays.
TEST(MotionVectors, OfOtherMethodsAreThoseOfTheReference)
{
    auto const scene = room_with_walker();
    Picture const reference = second_frame(start_reference_frames, scene, true);
    for (Method const& m : methods()) {
        if (m.ends_frames_early) continue; // those of a G-buffer
        Picture const own = second_frame(m.frames, scene, true);
        ASSERT_NE(own.find("motion"), nullptr) << m.name;
        std::size_t differ = 0;
        for (std::size_t i = 0; i < own.pixels(); ++i)
            differ += rgb(*own.find("motion"), i) != rgb(*reference.find("motion"), i);
        EXPECT_EQ(differ, 0u) << m.name;
    }
}

/// Views that disappear, return or change their size get no false motion vectors.
TEST(MotionVectors, OfViewsOfTheReferenceStartWithNone)
{
    Report report;
    MovingWorld moving(room_with_walker(), 0, report);
    Camera const camera = moving.world().cameras.at(0), aside = a_step_aside(camera);
    auto const frames = start_reference_frames(moving, camera, one_path(), report);
    FrameView const one[]{{camera, 16, 16}}, two[]{{aside, 16, 16}, {aside, 8, 8}};
    frames->views(one, 1, VertexSharing::none, {});
    auto const results = frames->views(two, 1, VertexSharing::none, {});
    std::size_t still = 0;
    for (std::size_t i = 0; i < 64; ++i) still += rgb(*results[1].picture.find("motion"), i).x == 0;
    EXPECT_EQ(still, 64u);
    EXPECT_NE(rgb(*results[0].picture.find("motion"), 100).x, 0);
}

} // namespace
} // namespace gi::test
