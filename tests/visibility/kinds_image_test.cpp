// Differences between the six kinds of visibility, pixel by pixel: they share camera paths and virtual lights.

#include "tests/visibility/visibility_render.h"

#include <fmt/format.h>

namespace gi::test {
namespace {

std::vector<float> indirect(VisibilityKind kind, World const& world, RenderSettings const& s)
{
    return render_visibility(kind, world, in_the_box(), s).result.picture.find("L2")->data;
}

double rms_difference(std::vector<float> const& a, std::vector<float> const& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += double(square(a[i] - b[i]));
    return std::sqrt(sum / double(a.size()));
}

TEST(VisibilityKinds, NoneIsAnUpperBoundOfEachInEveryPixel)
{
    World const world = world_of(box_with_block());
    RenderSettings const s = small_picture(32, 4, 2);
    auto const none = indirect(VisibilityKind::none, world, s);
    for (VisibilityKind const kind : kKinds) {
        auto const other = indirect(kind, world, s);
        double sum = 0, sum_none = 0;
        for (std::size_t i = 0; i < none.size(); ++i) {
            EXPECT_LE(other[i], none[i] * (1 + 1e-5f)) << int(kind) << ", value " << i;
            sum += double(other[i]);
            sum_none += double(none[i]);
        }
        if (kind != VisibilityKind::none) {
            EXPECT_LT(sum, 0.97 * sum_none) << int(kind) << ": something is hidden here";
            EXPECT_GT(sum, 0.2 * sum_none) << int(kind);
        }
    }
}

TEST(VisibilityKinds, AllHaveTheSameDirectLightBitForBit)
{
    World const world = world_of(box_with_block());
    RenderSettings const s = small_picture(24, 3, 2);
    Picture const exact = render_visibility(VisibilityKind::exact, world, in_the_box(), s).result.picture;
    for (VisibilityKind const kind : kKinds) {
        Picture const p = render_visibility(kind, world, in_the_box(), s).result.picture;
        for (char const* const layer : {"L0", "L1", "albedo", "depth"})
            EXPECT_EQ(p.find(layer)->data, exact.find(layer)->data) << layer << " of " << int(kind);
    }
}

TEST(VisibilityKinds, OcclusionWithoutARadiusIsNoneAndWithALargeOneDirectionalIsExact)
{
    World const world = world_of(box_with_block());
    RenderSettings s = small_picture(24, 3, 2);
    s.of<VirtualLightSettings>().ao_radius_m = 0;
    auto const none = indirect(VisibilityKind::none, world, s);
    EXPECT_EQ(indirect(VisibilityKind::ambient, world, s), none);
    EXPECT_EQ(indirect(VisibilityKind::directional, world, s), none);
    s.of<VirtualLightSettings>().ao_radius_m = 1e-5f;
    EXPECT_LT(rms_difference(indirect(VisibilityKind::ambient, world, s), none), 1e-3);
    s.of<VirtualLightSettings>().ao_radius_m = 100;
    EXPECT_EQ(indirect(VisibilityKind::directional, world, s), indirect(VisibilityKind::exact, world, s));
}

TEST(VisibilityKinds, WiderOcclusionIsDarker)
{
    World const world = world_of(box_with_block());
    RenderSettings s = small_picture(24, 4, 2);
    for (VisibilityKind const kind : {VisibilityKind::ambient, VisibilityKind::directional}) {
        double last = 1e9;
        for (float const radius : {0.1f, 0.3f, 1.0f}) {
            s.of<VirtualLightSettings>().ao_radius_m = radius;
            double const mean = mean_of(render_visibility(kind, world, in_the_box(), s).result.picture, "L2").mean;
            EXPECT_LT(mean, last) << int(kind) << ", radius " << radius;
            last = mean;
        }
    }
}

TEST(VisibilityKinds, AmbientOcclusionOfACornerIsItsClosedForm)
{
    // Floor and wall at right angles, a point of the floor at distance d of the wall. Its cosine-weighted
    // hemisphere is a unit disk; the wall is hit within 1 m beyond the chord at distance d of the disk's centre.
    Scene scene;
    int const grey = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {0, 0, 3}, {6, 0, 0}, {0, 0, -6}, grey); // floor, x > 0
    add_quad(scene, {0, 0, -3}, {0, 6, 0}, {0, 0, 6}, grey); // wall at x = 0, faces +x
    Light sun;
    sun.type = LightType::directional;
    sun.direction = glm::normalize(vec3{-1, -0.5f, 0});
    sun.intensity = vec3{3};
    add_light(scene, sun);
    World const world = world_of(scene);
    RenderSettings s = small_picture(4, 64, 1);
    s.of<VirtualLightSettings>().ao_radius_m = 1;
    s.of<VirtualLightSettings>().near_m = 1e-3f; // nothing from camera paths
    for (double const d : {0.02, 0.5, 1.5}) {
        Camera const eye = orthographic({d, 0.5, 0}, {d, 0, 0}, 0.002);
        double const
            ambient = mean_of(render_visibility(VisibilityKind::ambient, world, eye, s).result.picture, "L2").mean,
            none = mean_of(render_visibility(VisibilityKind::none, world, eye, s).result.picture, "L2").mean;
        double const c = std::min(1.0, d), hidden = (std::acos(c) - c * std::sqrt(1 - c * c)) / glm::pi<double>();
        EXPECT_NEAR(ambient / none, 1 - hidden, 0.03) << d;
    }
}

TEST(VisibilityKinds, HitBuffersComeNearerToExactWithTheirQuality)
{
    World const world = world_of(box_with_block());
    RenderSettings s = small_picture(24, 8, 2);
    auto const exact = indirect(VisibilityKind::exact, world, s);
    std::vector<double> errors;
    for (auto const& [directions, resolution] :
         {std::pair{"icosahedron:20", 16}, std::pair{"icosahedron:320", 64}, std::pair{"icosahedron:5120", 128}}) {
        s.of<SlhbSettings>().directions = directions;
        s.of<SlhbSettings>().resolution = resolution;
        errors.push_back(rms_difference(indirect(VisibilityKind::slhb, world, s), exact));
    }
    double const all = rms_difference(indirect(VisibilityKind::none, world, s), exact);
    EXPECT_LT(errors[1], 0.7 * errors[0]);
    EXPECT_LT(errors[2], 0.7 * errors[1]);
    EXPECT_LT(errors[2], 0.1 * all) << errors[2] << " of " << all;
}

TEST(VisibilityKinds, ImperfectMapsComeNearerToExactWithTheirPoints)
{
    World const world = world_of(box_with_block());
    RenderSettings s = small_picture(16, 4, 2);
    auto const exact = indirect(VisibilityKind::exact, world, s);
    std::vector<double> errors;
    for (auto const& [points, map] : {std::pair{64, 32}, std::pair{2048, 128}, std::pair{131072, 512}}) {
        s.of<VirtualLightSettings>().points = points;
        s.of<VirtualLightSettings>().point_map = map;
        errors.push_back(rms_difference(indirect(VisibilityKind::imperfect, world, s), exact));
    }
    double const all = rms_difference(indirect(VisibilityKind::none, world, s), exact);
    EXPECT_LT(errors[1], 0.7 * errors[0]);
    EXPECT_LT(errors[2], 0.7 * errors[1]);
    EXPECT_LT(errors[2], 0.1 * all) << errors[2] << " of " << all;
}

TEST(VisibilityKinds, OneThreadAndTwoGiveTheSameBits)
{
    World const world = world_of(box_with_block());
    RenderSettings s = small_picture(40, 3, 2);
    for (VisibilityKind const kind : kKinds) {
        s.threads = 1;
        Picture const one = render_visibility(kind, world, in_the_box(), s).result.picture;
        s.threads = 2;
        Picture const two = render_visibility(kind, world, in_the_box(), s).result.picture;
        for (Layer const& layer : one.layers)
            EXPECT_EQ(layer.data, two.find(layer.name)->data) << layer.name << " of " << int(kind);
    }
}

TEST(VisibilityKinds, SharesOfThePathsMakeUpThePicture)
{
    World const world = world_of(box_with_block());
    RenderSettings s = small_picture(16, 4, 1);
    for (VisibilityKind const kind : kKinds) {
        auto const whole = indirect(kind, world, s);
        RenderSettings part = s;
        part.share = {0, 2, {}};
        auto const first = indirect(kind, world, part);
        part.share = {2, 2, {}};
        auto const last = indirect(kind, world, part);
        for (std::size_t i = 0; i < whole.size(); ++i)
            EXPECT_NEAR(whole[i], 0.5f * (first[i] + last[i]), 1e-5f * (1 + whole[i])) << int(kind);
    }
}

} // namespace
} // namespace gi::test
