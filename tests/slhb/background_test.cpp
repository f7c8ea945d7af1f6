// What the camera sees past all surfaces, in every method: the map, a colour, or nothing.

#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/reference/reference.h"
#include "tests/slhb/slhb_render.h"

namespace gi::test {
namespace {

using Render = Picture (*)(World const&, RenderSettings const&);

Camera const kCamera = look_at({0, 0, 3}, {0, 0, 0}, 60);

Picture by_reference(World const& world, RenderSettings const& s)
{
    StopRequest stop;
    Report report;
    return render_reference(world, kCamera, s, stop, {}, report).picture;
}
Picture by_slhb(World const& world, RenderSettings const& s)
{
    return render_small(world, kCamera, s).result.picture;
}
Picture by_kernels(World const& world, RenderSettings const& s)
{
    StopRequest stop;
    Report report;
    return render_by_kernels(Space::host, world, kCamera, s, stop, {}, report).picture;
}

class Backgrounds : public testing::TestWithParam<Render> {
protected:
    static constexpr int kSize = 24;
    static Picture render(Material const& material, Background const& background)
    {
        Scene scene;
        add_sphere(scene, vec3{0}, 1, 3, add_material(scene, material), true);
        set_environment(scene, {1, 2, 3});
        scene.background = background;
        return GetParam()(world_of(std::move(scene)), small_settings(kSize, 16, 2));
    }
    static vec3 at(Picture const& p, char const* layer, std::size_t pixel) { return rgb(*p.find(layer), pixel); }
    static constexpr std::size_t kCorner = 0, kMiddle = kSize / 2 * kSize + kSize / 2;
};

TEST_P(Backgrounds, TheMapIsSeenUnlessSaidOtherwise)
{
    Picture const p = render(lambert(vec3{0.5f}), {});
    EXPECT_EQ(p.find("alpha"), nullptr);
    EXPECT_NEAR(glm::length(at(p, "color", kCorner) - vec3{1, 2, 3}), 0, 1e-5f);
}

TEST_P(Backgrounds, AColourReplacesTheMapAndLightsNothing)
{
    Material const grey = lambert(vec3{0.5f});
    Picture const map = render(grey, {}), color = render(grey, {BackgroundKind::color, {0.25f, 0.5f, 0.75f}});
    EXPECT_EQ(color.find("alpha"), nullptr);
    EXPECT_EQ(at(color, "color", kCorner), (vec3{0.25f, 0.5f, 0.75f}));
    EXPECT_EQ(at(color, "color", kMiddle), at(map, "color", kMiddle));
    for (char const* const layer : {"L1", "L2"})
        EXPECT_EQ(color.find(layer)->data, map.find(layer)->data) << layer;
}

TEST_P(Backgrounds, TransparentColoursAreMultipliedByTheirCoverage)
{
    Material const grey = lambert(vec3{0.5f});
    Picture const map = render(grey, {}), cut = render(grey, {BackgroundKind::transparent, vec3{0}});
    Layer const& alpha = *cut.find("alpha");
    ASSERT_EQ(alpha.channels, 1);
    EXPECT_EQ(alpha.data[kCorner], 0);
    EXPECT_EQ(alpha.data[kMiddle], 1);
    EXPECT_EQ(at(cut, "color", kCorner), vec3{0});
    std::size_t partly = 0;
    for (std::size_t p = 0; p < alpha.data.size(); ++p) { // laid over the map, it is the picture with the map
        partly += alpha.data[p] > 0 && alpha.data[p] < 1;
        EXPECT_EQ(alpha.data[p] * 16, std::round(alpha.data[p] * 16)) << "of 16 paths";
        vec3 const over = at(cut, "color", p) + (1 - alpha.data[p]) * vec3{1, 2, 3};
        EXPECT_NEAR(glm::length(over - at(map, "color", p)), 0, 1e-4f) << p;
    }
    EXPECT_GT(partly, 8u);
}

TEST_P(Backgrounds, MirrorsAndGlassShowTheMap)
{
    if (GetParam() == by_kernels) return; // they end paths there
    for (Material const& material : {mirror(vec3{1}), glass(1.5f, true), glass(1.5f, false)}) {
        Picture const map = render(material, {}), cut = render(material, {BackgroundKind::transparent, vec3{0}});
        EXPECT_EQ(at(cut, "color", kMiddle), at(map, "color", kMiddle));
        EXPECT_GT(at(cut, "color", kMiddle).z, 2);
        EXPECT_EQ(cut.find("alpha")->data[kMiddle], 1);
    }
}

std::string name_of(testing::TestParamInfo<Render> const& method)
{
    return method.param == by_reference ? "Reference" : method.param == by_slhb ? "Slhb" : "Kernels";
}

INSTANTIATE_TEST_SUITE_P(Of, Backgrounds, testing::Values(by_reference, by_slhb, by_kernels), name_of);

} // namespace
} // namespace gi::test
