// Shares of the paths of a picture, rendered apart and added, are the picture that one process renders.

#include "gi/hit_buffers/settings.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/reference/reference.h"
#include "gi/render/accumulator.h"
#include "tests/slhb/slhb_render.h"

#include <cstring>

namespace gi::test {
namespace {

World shared_room()
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert({0.7f, 0.6f, 0.5f})), true);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{6})));
    add_sphere(scene, {-0.4f, -0.5f, 0}, 0.4f, 2, add_material(scene, mirror(vec3{0.9f})), true);
    return world_of(scene);
}

using RenderShare = std::function<RenderResult(World const&, Camera const&, RenderSettings const&)>;

Accumulator sums_of(World const& world, RenderSettings settings, PathShare share, RenderShare const& render)
{
    Accumulator sums(settings.width, settings.height);
    settings.share = std::move(share);
    settings.share.merge = [&](Accumulator& a) { sums.add(a); };
    render(world, look_at({0, 0, 0.95}, {0, -0.2, 0}, 80), settings);
    return sums;
}

void expect_shares_make_the_whole(RenderSettings const& settings, RenderShare const& render)
{
    World const world = shared_room();
    Accumulator const whole = sums_of(world, settings, {}, render);
    Accumulator parts(settings.width, settings.height);
    std::uint32_t first = 0;
    for (std::uint32_t const count : {5u, 0u, 7u, 4u}) {
        parts.add(sums_of(world, settings, {first, count, {}}, render));
        first += count;
        EXPECT_EQ(parts.paths, first);
    }
    ASSERT_EQ(first, settings.paths);
    EXPECT_EQ(parts.paths, whole.paths);
    EXPECT_EQ(parts.counts.nearest_rays, whole.counts.nearest_rays);
    EXPECT_EQ(parts.counts.shadow_rays, whole.counts.shadow_rays);
    constexpr std::size_t kFloats = (sizeof(PixelMeans) - sizeof(PixelMeans::hits)) / sizeof(float);
    float worst = 0;
    for (std::size_t p = 0; p < whole.pixels.size(); ++p) {
        std::array<float, kFloats> a, b;
        std::memcpy(a.data(), &whole.pixels[p], sizeof a);
        std::memcpy(b.data(), &parts.pixels[p], sizeof b);
        for (std::size_t k = 0; k < kFloats; ++k)
            worst = std::max(worst, std::abs(a[k] - b[k]) / std::max(1.0f, std::abs(a[k])));
        EXPECT_EQ(whole.pixels[p].hits, parts.pixels[p].hits);
    }
    EXPECT_LE(worst, 2e-6f); // means of 16 paths in another order
}

using Function = RenderResult(World const&, Camera const&, RenderSettings const&, StopRequest const&,
                              RenderProgress const&, Report&);

RenderShare with(Function* function)
{
    return [function](World const& world, Camera const& camera, RenderSettings const& s) {
        Report report;
        return function(world, camera, s, StopRequest(), {}, report);
    };
}

TEST(PathShare, OfTheReference)
{
    expect_shares_make_the_whole(small_settings(24, 16, 8), with(render_reference));
}

TEST(PathShare, OfSlhbWithEverySchedule)
{
    for (Schedule const schedule : {Schedule::streamed, Schedule::stored, Schedule::temporal}) {
        RenderSettings s = small_settings(24, 16, 4);
        s.of<SlhbSettings>().schedule = schedule;
        SCOPED_TRACE(int(schedule));
        expect_shares_make_the_whole(s, with(render_slhb));
    }
}

TEST(PathShare, OfSlhbWithLampsThatStay)
{
    RenderSettings s = small_settings(24, 16, 4);
    s.of<SlhbSettings>().schedule = Schedule::temporal;
    s.of<SlhbSettings>().light_samples = 4;
    s.of<SlhbSettings>().fresh_light_samples = 1;
    s.of<PathsSettings>().interleave = 2;
    expect_shares_make_the_whole(s, with(render_slhb));
}

TEST(PathShare, OfSlhbByKernels)
{
    expect_shares_make_the_whole(
        small_settings(24, 16, 4), [](World const& world, Camera const& camera, RenderSettings const& s) {
            Report report;
            return render_by_kernels(Space::host, world, camera, s, StopRequest(), {}, report);
        });
}

} // namespace
} // namespace gi::test
