// slhb with exact rays in place of look-ups: what bench accuracy measures biases against has none itself.

#include "gi/hit_buffers/settings.h"
#include "gi/methods/reference/reference.h"
#include "tests/slhb/slhb_render.h"

namespace gi::test {
namespace {

/// Mean of L2 over `seeds` renders and its standard error.
template <class Render>
Estimate indirect_over_seeds(RenderSettings s, int seeds, Render const& render)
{
    double sum = 0, squares = 0;
    for (int k = 0; k < seeds; ++k) {
        s.seed = std::uint64_t(100 + k);
        double const m = mean_of(render(s), "L2").mean;
        sum += m;
        squares += m * m;
    }
    double const n = seeds, mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

TEST(SlhbExactParts, WithoutLookUpsThereIsNoBias)
{
    World const world = world_of(box_with_block_and_lamp());
    Camera const camera = look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70);
    constexpr int kSeeds = 8;
    RenderSettings s = small_settings(24, 128, 2);
    Estimate const truth = indirect_over_seeds(s, kSeeds, [&](RenderSettings const& now) {
        StopRequest stop;
        Report report;
        return render_reference(world, camera, now, stop, {}, report).picture;
    });
    s.of<SlhbSettings>().schedule = Schedule::streamed;
    s.of<SlhbSettings>().axes = 8;
    s.of<SlhbSettings>().light_samples = 8;
    for (bool const own_directions : {false, true}) {
        s.of<SlhbSettings>().exact = {.queries = true, .shadows = true, .directions = own_directions};
        Estimate const exact = indirect_over_seeds(s, kSeeds, [&](RenderSettings const& now) {
            return render_small(world, camera, now).result.picture;
        });
        double const error = std::hypot(truth.sigma, exact.sigma);
        EXPECT_LT(error, 0.01 * truth.mean); // else the next line says nothing
        EXPECT_NEAR(exact.mean, truth.mean, 4 * error) << own_directions;
    }
}

/// A veil under an opening whose edges raise doubts: whether it is in a texel is drawn by lot, and by rays once more.
TEST(SlhbConfirmed, VeilsKeepTheirShareOfTheLight)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.6f}));
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, matt);
    for (float const x : {-1.0f, -0.1f, 0.8f}) add_box(scene, {x, 1, -1}, {x + 0.2f, 1.05f, 1}, matt, false);
    Material veil = lambert(vec3{0.5f});
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.5f;
    add_quad(scene, {-1, 0.5f, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, veil));
    set_environment(scene, vec3{1});
    World const world = world_of(std::move(scene));
    Camera const camera = look_at({0, 0.25, 0.9}, {0, 0, 0}, 60);
    RenderSettings s = small_settings(16, 256, 2);
    Report report;
    auto const light = [&](RenderFunction render, Confirming confirm, char const* layer) {
        s.of<SlhbSettings>().confirm = confirm;
        return mean_of(render(world, camera, s, {}, {}, report).picture, layer).mean;
    };
    for (char const* layer : {"L1", "L2"}) {
        double const truth = light(render_reference, Confirming::off, layer),
                     on = light(render_slhb, Confirming::on, layer);
        std::cout << layer << ": " << on / truth << " of the light\n";
        EXPECT_NEAR(on, truth, 0.02 * truth) << layer;
    }
}

TEST(SlhbExactParts, NothingIsLookedUp)
{
    // Open, under a sky and parallel light: render_small checks that all is finite.
    Scene scene;
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
    add_sphere(scene, {0, 0.4f, 0}, 0.4f, 2, add_material(scene, lambert(vec3{0.8f})), true);
    set_environment(scene, vec3{1});
    Light light_point;
    light_point.type = LightType::directional;
    light_point.direction = {0, -1, 0};
    light_point.intensity = vec3{1};
    add_light(scene, light_point);
    World const world = world_of(scene);
    Camera const camera = look_at({1, 1, 2}, {0, 0.2, 0}, 50);
    for (Schedule const schedule : {Schedule::streamed, Schedule::stored}) {
        RenderSettings s = small_settings(16, 64, 2);
        s.of<SlhbSettings>().schedule = schedule;
        SlhbRun const look_ups = render_small(world, camera, s);
        s.of<SlhbSettings>().exact = {.queries = true, .shadows = true};
        SlhbRun const exact = render_small(world, camera, s);
        EXPECT_EQ(exact.counts.at("hit-buffer queries"), 0);
        EXPECT_GT(exact.counts.at("exact rays"), 0);
        double const truth = mean_of(exact.result.picture).mean;
        EXPECT_NEAR(mean_of(look_ups.result.picture).mean, truth, 0.01 * truth);
    }
}

} // namespace
} // namespace gi::test
