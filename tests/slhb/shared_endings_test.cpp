// Endings in cells: the mean of many passes is that of paths which go on alone but for a little blur of what is
// sent on, for far fewer paths that go on.

#include "gi/scene/generate.h"
#include "gi/slhb/frames.h"
#include "gi/transport/accumulator.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/scenes.h"

#include <tbb/global_control.h>

namespace gi::test {
namespace {

constexpr int kEndingSize = 64;

RenderSettings settings_of_cells()
{
    RenderSettings s = small_settings(kEndingSize, 1, 3);
    s.slhb.schedule = Schedule::stored;
    s.slhb.directions = "icosahedron:320";
    s.slhb.resolution = 64;
    s.slhb.shadow_resolution = 64;
    return s;
}

struct Seen {
    Picture picture;
    double shaded; ///< endings, per pass
};

Seen see(MovingWorld const& world, Camera const& camera, Endings endings, std::uint32_t paths,
         RenderSettings const& s = settings_of_cells())
{
    Report report;
    FrameView const view{camera, kEndingSize, kEndingSize};
    auto result = start_slhb_frames(world, camera, s, report)->views({&view, 1}, paths, endings, {});
    return {std::move(result[0].picture), report.counts().at("endings shaded for several paths") / double(paths)};
}

Camera in_box() { return look_at({-0.6, 0.1, 0.9}, {0.1, -0.4, 0}, 60); }

TEST(SharedEndings, InCellsBringTheSameLight)
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(box_with_block_and_lamp()), 0, report);
    Seen const exact = see(world, in_box(), Endings::exact, 256),
               cells = see(world, in_box(), Endings::in_cells, 256);
    EXPECT_EQ(exact.shaded, 0);
    EXPECT_GT(cells.shaded, 100);
    EXPECT_LT(cells.shaded, 0.6 * kEndingSize * kEndingSize);
    EXPECT_NEAR(mean_of(cells.picture).mean / mean_of(exact.picture).mean, 1, 0.003);
    EXPECT_EQ(cells.picture.find("L1")->data, exact.picture.find("L1")->data)
        << "direct light is each pixel's own";
    // Where the light arrives, too: means of blocks of pixels, so that noise does not hide it.
    auto const blocks = [](Layer const& l) {
        constexpr int kAcross = 8;
        std::vector<double> sums(std::size_t(kAcross * kAcross));
        for (int y = 0; y < kEndingSize; ++y)
            for (int x = 0; x < kEndingSize; ++x)
                sums[std::size_t(y * kAcross / kEndingSize * kAcross + x * kAcross / kEndingSize)] +=
                    double(luminance(rgb(l, std::size_t(y * kEndingSize + x))));
        return sums;
    };
    auto const a = blocks(*exact.picture.find("L2")), b = blocks(*cells.picture.find("L2"));
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(b[k], a[k], 0.04 * a[k] + 0.01) << k;
}

/// A closed sphere that shines and reflects everywhere alike: every cell sends back the same.
TEST(SharedEndings, InCellsKeepTheFurnace)
{
    Scene scene;
    Material wall = lambert(vec3{0.5f});
    wall.emission = vec3{0.5f};
    wall.double_sided = true;
    add_sphere(scene, vec3{0}, 1, 4, add_material(scene, wall), false);
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(std::move(scene)), 0, report);
    RenderSettings s = settings_of_cells();
    s.bounces = 16;
    s.slhb.lamps = 8;
    s.slhb.shadow_resolution = 128;
    Seen const seen = see(world, look_at({0.1, 0.2, 0.1}, {-1, -0.5, -0.7}, 90), Endings::in_cells, 64, s);
    EXPECT_NEAR(mean_of(seen.picture).mean, 1, 0.005);
}

TEST(SharedEndings, DoNotDependOnThreads)
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(box_with_block_and_lamp()), 0, report);
    auto const run = [&](std::size_t threads) {
        tbb::global_control const most(tbb::global_control::max_allowed_parallelism, threads);
        return see(world, in_box(), Endings::in_cells, 3).picture.find("color")->data;
    };
    EXPECT_EQ(run(1), run(2));
}

/// Cells are as wide as a share of the distance from the eye: neither a huge nor a tiny world, nor one far from
/// the origin, has more of them.
TEST(SharedEndings, CellsGoWithTheSizeOfTheWorld)
{
    Report report;
    std::vector<double> shaded;
    for (float const scale : {1.0f, 1e-4f, 1e5f}) {
        Scene scene = box_with_block_and_lamp();
        for (Mesh& mesh : scene.meshes)
            for (vec3& p : mesh.positions) p *= scale;
        MovingWorld const world(std::make_shared<Scene const>(std::move(scene)), 0, report);
        Camera camera = in_box();
        camera.world_from_camera[3] = glm::dvec4(dvec3(camera.world_from_camera[3]) * double(scale), 1);
        shaded.push_back(see(world, camera, Endings::in_cells, 4).shaded);
    }
    EXPECT_NEAR(shaded[1] / shaded[0], 1, 0.1);
    EXPECT_NEAR(shaded[2] / shaded[0], 1, 0.1);
}

} // namespace
} // namespace gi::test
