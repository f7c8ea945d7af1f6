// Light samples from a pool: what they bring in the mean is what light sampling brings.

#include "gi/methods/paths/light_pool.h"

#include "gi/core/rng.h"
#include "tests/slhb/slhb_render.h"

namespace gi::test {
namespace {

/// Lights of every kind about the origin: surfaces that shine to one and to both sides,
/// a point, parallel light, a sky.
Scene lights_of_all_kinds()
{
    Scene scene;
    add_quad(scene, {-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{5})));
    Material both = emitter(vec3{3, 2, 1});
    both.double_sided = true;
    add_quad(scene, {1, 0.5f, -0.3f}, {0, 0.4f, 0}, {0, 0, 0.6f}, add_material(scene, both));
    Light light;
    light.type = LightType::point;
    light.position = {-1, 1, 0.5f};
    light.intensity = vec3{2};
    add_light(scene, light);
    light.type = LightType::directional;
    light.direction = glm::normalize(vec3{0.2f, -1, 0.1f});
    light.intensity = vec3{0.7f};
    add_light(scene, light);
    set_environment(scene, vec3{0.3f});
    return scene;
}

/// Irradiance of a sample, luminance.
double brings(LightSample const& s, vec3 normal)
{
    return s.pdf > 0 ? double(luminance(s.radiance) / s.pdf * std::max(0.0f, glm::dot(s.direction, normal))) : 0;
}

TEST(LightPool, BringsWhatLightSamplingBrings)
{
    World const world = world_of(lights_of_all_kinds());
    WorldView const w = view(world);
    vec3 const point{0.1f, 0, 0.2f}, normal = glm::normalize(vec3{0.3f, 1, -0.1f});
    Pcg32 rng(7, 1);
    double truth = 0;
    constexpr int kDraws = 1 << 20;
    for (int k = 0; k < kDraws; ++k)
        truth += brings(sample_light(w, choose_light(w, rng.uniform_double()), point, rng.uniform2()), normal);
    truth /= kDraws;

    LightOrder order;
    order.update(world);
    LightPool pool;
    double sum = 0;
    constexpr std::uint32_t kPasses = 64, kPicks = 4096;
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
        pool.fill(order, world, 64, 3, pass);
        for (std::uint32_t k = 0; k < kPicks; ++k) {
            ChosenLight const c = pool.choose(point, normal, rng.uniform(), rng.uniform());
            if (c.light != nullptr) sum += double(c.weight) * brings(c.light->seen_from(w, point), normal);
        }
    }
    EXPECT_NEAR(sum / (kPasses * kPicks), truth, 0.005 * truth);
}

TEST(LightPool, SamplesAreThoseOfLightSampling)
{
    World const world = world_of(lights_of_all_kinds());
    WorldView const w = view(world);
    LightOrder order;
    order.update(world);
    LightPool pool;
    pool.fill(order, world, 64, 3, 5);
    Pcg32 rng(9, 1);
    vec3 const normal{0, 1, 0};
    int seen = 0;
    for (int k = 0; k < 2000; ++k) {
        vec3 const point{2 * rng.uniform() - 1, 0, 2 * rng.uniform() - 1};
        ChosenLight const c = pool.choose(point, normal, rng.uniform(), rng.uniform());
        if (c.light == nullptr) continue;
        LightSample const here = c.light->seen_from(w, point),
                          there = sample_light(w, c.light->choice, point, c.light->u);
        ++seen;
        EXPECT_NEAR(here.pdf, there.pdf, 1e-4f * there.pdf);
        EXPECT_LT(glm::length(here.direction - there.direction), 1e-5f);
        EXPECT_LT(glm::length(here.radiance - there.radiance), 1e-5f * glm::length(there.radiance));
    }
    EXPECT_GT(seen, 1900);
}

TEST(LightPool, IsEmptyWhereNothingShines)
{
    Scene scene;
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
    World const world = world_of(std::move(scene));
    LightOrder order;
    order.update(world);
    LightPool pool;
    pool.fill(order, world, 8, 0, 0);
    EXPECT_TRUE(pool.empty());
}

/// A thousand lamps of very different reach: the near ones are chosen, and light is not lost.
TEST(LightPool, ManyLampsOfOnePlace)
{
    Scene scene;
    add_quad(scene, {-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, add_material(scene, lambert(vec3{0.5f})));
    Pcg32 rng(11, 1);
    Light light;
    light.type = LightType::point;
    for (int k = 0; k < 1000; ++k) {
        light.position = {100 * rng.uniform() - 50, 0.5f + rng.uniform(), 100 * rng.uniform() - 50};
        light.intensity = vec3{0.1f + rng.uniform()};
        add_light(scene, light);
    }
    World const world = world_of(scene);
    double truth = 0;
    for (Light const& l : world.lights) {
        vec3 const way = l.position; // from the origin
        truth += double(luminance(l.intensity) * way.y) / std::pow(double(glm::length(way)), 3);
    }
    RenderSettings s = small_settings(16, 4096, 0);
    double const seen =
        mean_of(render_small(world, orthographic({0, 1, 0}, {0, 0, 0}, 0.02), s).result.picture).mean;
    EXPECT_NEAR(seen, 0.5 / M_PI * truth, 0.01 * truth * 0.5 / M_PI);
}

} // namespace
} // namespace gi::test
