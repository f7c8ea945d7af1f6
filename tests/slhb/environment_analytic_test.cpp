// Light from environment maps, in both methods: one bright texel against a parallel light, turned maps against
// turned scenes, and a sun that must neither vanish nor leave single bright pixels.

#include "gi/hit_buffers/settings.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/reference/reference.h"
#include "gi/metrics/ztest.h"
#include "gi/scene/model/sky.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/statistics.h"

namespace gi::test {
namespace {

enum class Method : std::uint8_t { reference, streamed, stored, kernels };
constexpr Method kMethods[]{Method::reference, Method::streamed, Method::stored, Method::kernels};

Picture render_with(Method method, World const& world, Camera const& camera, RenderSettings s)
{
    StopRequest stop;
    Report report;
    s.of<SlhbSettings>().schedule = method == Method::stored ? Schedule::stored : Schedule::streamed;
    if (method == Method::reference) return render_reference(world, camera, s, stop, {}, report).picture;
    if (method == Method::kernels)
        return render_by_kernels(Space::host, world, camera, s, stop, {}, report).picture;
    return render_small(world, camera, s).result.picture;
}

std::string name_of(Method m)
{
    constexpr char const* kNames[]{"reference", "slhb streamed", "slhb stored", "slhb by kernels"};
    return kNames[int(m)];
}

/// A floor with a block and a wall, open to the sky; turned about +Y.
Scene yard(double turn_rad = 0)
{
    Scene scene;
    int const grey = add_material(scene, lambert(vec3{0.6f}));
    add_quad(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);
    add_quad(scene, {-2, 0, -1.2f}, {4, 0, 0}, {0, 1.5f, 0}, add_material(scene, lambert({0.7f, 0.4f, 0.2f})));
    add_box(scene, {-0.4f, 0, -0.3f}, {0.3f, 0.8f, 0.4f}, add_material(scene, lambert({0.3f, 0.6f, 0.4f})), false);
    for (Node& node : scene.nodes) node.rotation = glm::angleAxis(turn_rad, dvec3{0, 1, 0});
    return scene;
}

/// Looks down: little sky in the picture. Turned with the yard.
Camera yard_camera(double turn_rad = 0)
{
    dquat const turn = glm::angleAxis(turn_rad, dvec3{0, 1, 0});
    return look_at(turn * dvec3{1.4, 2.2, 2.6}, turn * dvec3{-0.1, 0.2, -0.3}, 40);
}

EnvironmentMap dark_map(std::uint32_t width)
{
    EnvironmentMap map;
    map.width = width;
    map.height = width / 2;
    map.radiance.assign(std::size_t(width) * width / 2, vec3{0});
    return map;
}

TEST(EnvironmentLight, OneBrightTexelIsAParallelLight)
{
    // 45 degrees up; the hat of a texel is 0.7 degrees to each side.
    constexpr std::uint32_t kWidth = 512, kRow = 64, kColumn = 300;
    constexpr float kRadiance = 20000;
    Scene with_map = yard(), with_light = yard();
    with_map.environment = dark_map(kWidth);
    with_map.environment->radiance[kRow * kWidth + kColumn] = vec3{kRadiance};
    double const texel = 2 * M_PI / kWidth, theta = (kRow + 0.5) * texel, phi = (kColumn + 0.5) * texel - M_PI;
    // Of a hat in theta times a hat in phi.
    double const solid_angle = 2 * std::sin(theta) * (1 - std::cos(texel));
    Light light;
    light.type = LightType::directional;
    light.direction =
        -vec3(dvec3{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)});
    light.intensity = vec3(float(kRadiance * solid_angle));
    add_light(with_light, light);
    World const map = world_of(with_map), light_point = world_of(with_light);
    for (Method const m : kMethods) {
        RenderSettings s = small_settings(24, m == Method::reference ? 512 : 96, 3);
        s.of<SlhbSettings>().shadow_resolution = 256;
        s.of<SlhbSettings>().light_samples = 8;
        s.of<SlhbSettings>().axes = 8;
        s.of<SlhbSettings>().resolution = 128;
        Picture const a = render_with(m, map, yard_camera(), s), b = render_with(m, light_point, yard_camera(), s);
        for (char const* const part : {"L1", "L2"}) {
            double const truth = mean_of(b, part).mean, found = mean_of(a, part).mean;
            EXPECT_GT(truth, part[1] == '1' ? 0.05 : 0.005);
            EXPECT_NEAR(found, truth, 0.01 * truth) << name_of(m) << " " << part;
        }
    }
}

TEST(EnvironmentLight, TurningTheMapIsTurningTheScene)
{
    SkyOptions options;
    options.width = 256;
    options.height = 128;
    EnvironmentMap map = sky_map(options);
    for (vec3& c : map.radiance) c *= 0.05f;
    constexpr double kTurn = 0.8;
    Scene turned_map = yard(), turned_scene = yard(-kTurn);
    turned_map.environment = map;
    turned_map.environment->rotation_rad = float(kTurn);
    turned_scene.environment = map;
    World const a = world_of(turned_map), b = world_of(turned_scene);
    for (Method const m : kMethods) {
        // Pixels of slhb share their axes and lamps: means over independent seeds are
        // compared, of all and of quarters.
        constexpr int kSeeds = 6, kSize = 24, kParts = 5;
        RunningMean mean_a[2][kParts], mean_b[2][kParts];
        for (int seed = 0; seed < kSeeds; ++seed) {
            RenderSettings s = small_settings(kSize, 64, 2);
            s.of<SlhbSettings>().axes = 4;
            s.of<SlhbSettings>().resolution = 64;
            s.of<SlhbSettings>().shadow_resolution = 128;
            for (bool const first : {true, false}) {
                s.seed = std::uint64_t(100 + 2 * seed + first);
                Picture const p =
                    first ? render_with(m, a, yard_camera(), s) : render_with(m, b, yard_camera(-kTurn), s);
                for (int part = 0; part < 2; ++part) {
                    Layer const& layer = *p.find(part == 0 ? "L1" : "L2");
                    double sums[kParts] = {};
                    for (int i = 0; i < kSize * kSize; ++i) {
                        int const quarter = (i / kSize < kSize / 2 ? 0 : 2) + (i % kSize < kSize / 2 ? 0 : 1);
                        double const v = double(luminance(rgb(layer, std::size_t(i))));
                        sums[quarter] += v;
                        sums[4] += v;
                    }
                    for (int k = 0; k < kParts; ++k) (first ? mean_a : mean_b)[part][k].add(sums[k]);
                }
            }
        }
        for (int part = 0; part < 2; ++part)
            for (int k = 0; k < kParts; ++k) {
                RunningMean const &x = mean_a[part][k], &y = mean_b[part][k];
                double const sigma = std::hypot(x.sigma(), y.sigma());
                EXPECT_LT(sigma, 0.05 * y.mean()) << name_of(m); // else the next line says nothing
                EXPECT_NEAR(x.mean(), y.mean(), 4.5 * sigma) << name_of(m) << " L" << part + 1 << " part " << k;
            }
    }
}

TEST(EnvironmentLight, ReferencePixelsUnderATurnedMapDifferByNoiseAlone)
{
    Scene turned_map = yard(), turned_scene = yard(-2.1);
    turned_map.environment = dark_map(64);
    for (std::size_t i = 0; i < turned_map.environment->radiance.size(); ++i)
        turned_map.environment->radiance[i] = vec3{0.5f, 0.6f, 0.7f} * float(1 + i % 64 / 16);
    turned_scene.environment = turned_map.environment;
    turned_map.environment->rotation_rad = 2.1f;
    RenderSettings s = small_settings(32, 1024, 2);
    Picture const a = render_with(Method::reference, world_of(turned_map), yard_camera(), s);
    s.seed = 6;
    Picture const b = render_with(Method::reference, world_of(turned_scene), yard_camera(-2.1), s);
    ZTest const z =
        z_test(a.find("color")->data, a.find("variance")->data, b.find("color")->data, b.find("variance")->data);
    EXPECT_GT(z.sidak_p, 0.001);
    Estimate const mean_a = mean_of(a), mean_b = mean_of(b); // channels of a pixel share their paths
    double const mean_z = (mean_a.mean - mean_b.mean) / std::hypot(mean_a.sigma, mean_b.sigma);
    EXPECT_LT(std::abs(mean_z), 3.5);
}

/// Most of the light comes from a sun that is smaller than a texel, or covers a few.
World sunny_yard(std::uint32_t width)
{
    SkyOptions options;
    options.width = width;
    options.height = width / 2;
    Scene scene = yard();
    scene.environment = sky_map(options);
    scene.environment->scale = vec3{0.02f};
    return world_of(scene);
}

TEST(EnvironmentLight, ASmallSunLeavesNoSingleBrightPixels)
{
    for (std::uint32_t const width : {128u, 1024u}) {
        World const world = sunny_yard(width);
        RenderSettings s = small_settings(48, 512, 3);
        Picture const truth = render_with(Method::reference, world, yard_camera(), s);
        float brightest = 0;
        for (float const v : truth.find("color")->data) brightest = std::max(brightest, v);
        for (Method const m : kMethods)
            for (std::uint32_t const paths : {1u, 4u, 16u}) {
                s.paths = paths;
                Picture const p = render_with(m, world, yard_camera(), s);
                float most = 0;
                std::size_t above_2 = 0;
                for (float const v : p.find("color")->data) {
                    most = std::max(most, v / brightest);
                    above_2 += v > 2 * brightest;
                }
                EXPECT_LT(most, paths == 1 ? 5 : paths == 4 ? 3 : 2) << width << " " << name_of(m) << " " << paths;
                EXPECT_LT(double(above_2), 0.02 * double(p.pixels()))
                    << width << " " << name_of(m) << " " << paths;
                if (paths == 16) {
                    double const truth_mean = mean_of(truth).mean;
                    EXPECT_NEAR(mean_of(p).mean, truth_mean, 0.05 * truth_mean) << width << " " << name_of(m);
                }
            }
    }
}

TEST(EnvironmentLight, ASmallSunIsInEveryPass)
{
    World const world = sunny_yard(1024);
    RenderSettings s = small_settings(32, 512, 0);
    double const truth = mean_of(render_with(Method::reference, world, yard_camera(), s), "L1").mean;
    for (Method const m : kMethods) {
        double least = 1e9, most = 0;
        for (std::uint64_t seed = 0; seed < 24; ++seed) {
            s.paths = 1;
            s.seed = seed;
            double const mean = mean_of(render_with(m, world, yard_camera(), s), "L1").mean / truth;
            least = std::min(least, mean);
            most = std::max(most, mean);
        }
        EXPECT_GT(least, 0.7) << name_of(m);
        EXPECT_LT(most, 1.4) << name_of(m);
    }
}

} // namespace
} // namespace gi::test
