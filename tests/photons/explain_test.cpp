// What the photon methods say that they build, and why.

#include "gi/light_paths/impostors.h"
#include "gi/methods/photons/explain.h"

#include "gi/methods/photons/limits.h"
#include "tests/photons/photon_methods.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace gi::test {
namespace {

using Explain = std::vector<PlanItem> (*)(World const&, RenderSettings const&, Camera const&);
constexpr Explain kExplain[] = {explain_ispm, explain_lpv, explain_isllpm, explain_multi_image};

/// The item; one with the reason "missing" if there is none.
PlanItem item(std::vector<PlanItem> const& items, std::string const& what)
{
    auto const found = std::ranges::find(items, what, &PlanItem::what);
    return found != items.end() ? *found : PlanItem("missing", what, false, "missing");
}

bool says(PlanItem const& item, std::string const& words) { return item.reason.find(words) != std::string::npos; }

TEST(ExplainPhotons, NothingIsBuiltForNothing)
{
    Scene scene;
    Camera const camera = in_the_room();
    for (Explain const explain : kExplain) {
        auto const items = explain(world_of(scene), {}, camera);
        ASSERT_EQ(items.size(), 1u);
        EXPECT_FALSE(items[0].build);
        EXPECT_EQ(items[0].reason, "there are no surfaces");
    }
    add_box(scene, vec3{-1}, vec3{1}, add_material(scene, lambert(vec3{0.5f})), true);
    for (Explain const explain : kExplain)
        EXPECT_EQ(explain(world_of(scene), {}, camera)[0].reason, "there is no light");
    RenderSettings direct;
    direct.bounces = 0;
    for (Explain const explain : kExplain)
        EXPECT_TRUE(says(explain(world_of(room_with_mirror()), direct, camera)[0], "--bounces"));
}

TEST(ExplainPhotons, EachItemHasItsReason)
{
    World const world = world_of(room_with_mirror());
    RenderSettings s = small_photon_picture(64, 5000);
    for (Explain const explain : kExplain) {
        auto const items = explain(world, s, in_the_room());
        EXPECT_TRUE(item(items, "light paths").build);
        EXPECT_TRUE(says(item(items, "light paths"), "5000 for a set"));
        EXPECT_FALSE(item(items, "bounce maps").build);
        EXPECT_TRUE(says(item(items, "new photons when something moves"), "nothing moves"));
        EXPECT_TRUE(says(item(items, "light from afar towards what is shown"), "no sky"));
        for (PlanItem const& i : items) {
            EXPECT_FALSE(i.name.empty() || i.reason.empty()) << i.what;
            std::set<std::string> keys;
            for (PlanNumber const& n : i.numbers)
                EXPECT_TRUE(keys.insert(n.key).second) << i.what << ": " << n.key;
        }
    }
    EXPECT_FALSE(item(explain_ispm(world, s, in_the_room()), "distance impostors").build);
    EXPECT_FALSE(item(explain_lpv(world, s, in_the_room()), "caustics").build);
    EXPECT_TRUE(says(item(explain_isllpm(world, s, in_the_room()), "caustics"), "1250 light paths"));
    EXPECT_TRUE(says(item(explain_isllpm(world, s, in_the_room()), "caustics"), "2 smooth triangles"));
    auto const by_impostors = explain_multi_image(world, s, in_the_room());
    EXPECT_TRUE(says(item(by_impostors, "distance impostors"), "at most 8 cube maps of 6 x 64 x 64"));
    EXPECT_TRUE(item(by_impostors, "caustics in screen space").build);
    EXPECT_TRUE(says(
        item(explain_multi_image(world, s, orthographic({0, 0, 0.9}, {0, 0, 0}, 1)), "caustics in screen space"),
        "orthographic"));
    EXPECT_TRUE(item(explain_isllpm(world, s, in_the_room()), "lattice of caustics").build);
    RenderSettings kernels = s;
    kernels.of<PhotonSettings>().caustics_by = CausticsBy::kernels;
    PlanItem const none = item(explain_isllpm(world, kernels, in_the_room()), "lattice of caustics");
    EXPECT_FALSE(none.build);
    EXPECT_TRUE(says(none, "--caustics-by kernels")) << none.reason;
    s.of<PhotonSettings>().high_cells = kernels.of<PhotonSettings>().high_cells = 512;
    EXPECT_LT(PhotonLattices::bytes(lattices_of(kernels.of<PhotonSettings>()), world.bounds, 40),
              PhotonLattices::bytes(lattices_of(s.of<PhotonSettings>()), world.bounds, 40) / 2);
    s.of<PhotonSettings>().caustic_paths = 0;
    EXPECT_TRUE(says(item(explain_ispm(world, s, in_the_room()), "caustics"), "--caustic-photons 0"));
    s.of<PhotonSettings>().frozen = Switch::on;
    EXPECT_TRUE(
        says(item(explain_ispm(world, s, in_the_room()), "new photons when something moves"), "--frozen-light"));
    s.of<PhotonSettings>().first_bounce = FirstBounce::map;
    s.of<PhotonSettings>().rays = PhotonRays::look_ups;
    EXPECT_TRUE(item(explain_isllpm(world, s, in_the_room()), "bounce maps").build);
    EXPECT_TRUE(item(explain_isllpm(world, s, in_the_room()), "hit buffers of light paths").build);
    EXPECT_TRUE(says(item(explain_lpv(world, s, in_the_room()), "nested lattices"), "what the camera shows"));
    EXPECT_FALSE(item(explain_lpv(world, s, in_the_room()), "nested lattices").build);
    s.of<PhotonSettings>().propagation_cascades = 3;
    EXPECT_TRUE(item(explain_lpv(world, s, in_the_room()), "nested lattices").build);
}

/// A room on a plain of 400 m: lattices nest about what is shown, and the sky's light goes there.
TEST(ExplainPhotons, RoomInALargeWorld)
{
    Scene scene = room_with_mirror();
    add_quad(scene, {-200, -2, -200}, {0, 0, 400}, {400, 0, 0}, add_material(scene, lambert(vec3{0.5f})));
    set_environment(scene, vec3{1});
    World const world = world_of(scene);
    for (Explain const explain : kExplain) {
        auto const items = explain(world, {}, in_the_room());
        EXPECT_TRUE(item(items, "light from afar towards what is shown").build);
        EXPECT_EQ(item(items, "nested lattices").build, explain != explain_ispm);
    }
}

TEST(ExplainPhotons, CausticsNeedSomethingSmooth)
{
    Scene scene;
    add_box(scene, vec3{-1}, vec3{1}, add_material(scene, lambert(vec3{0.5f})), true);
    Light lamp;
    lamp.intensity = vec3{1};
    add_light(scene, lamp);
    World const world = world_of(scene);
    for (Explain const explain : {explain_ispm, explain_isllpm, explain_multi_image}) {
        PlanItem const caustics = item(explain(world, {}, in_the_room()), "caustics");
        EXPECT_FALSE(caustics.build);
        EXPECT_TRUE(says(caustics, "no smooth surface")) << caustics.reason;
    }
    EXPECT_FALSE(item(explain_isllpm(world, {}, in_the_room()), "lattice of caustics").build);
    EXPECT_FALSE(item(explain_multi_image(world, {}, in_the_room()), "caustics in screen space").build);
}

TEST(ExplainPhotons, MemoryThatWouldBeRefused)
{
    World const world = world_of(room_with_mirror());
    RenderSettings s;
    EXPECT_TRUE(item(explain_isllpm(world, s, in_the_room()), "memory of lattices").build);
    s.of<PhotonSettings>().low_cells = s.of<PhotonSettings>().middle_cells = s.of<PhotonSettings>().high_cells = 512;
    s.of<PhotonSettings>().lattice_cascades = 4;
    PlanItem const memory = item(explain_isllpm(world, s, in_the_room()), "memory of lattices");
    EXPECT_FALSE(memory.build);
    EXPECT_TRUE(says(memory, "refused")) << memory.reason;
    PhotonSettings p;
    p.impostors = 2;
    p.impostor_texels = 9; // rounded up to 16
    EXPECT_EQ(impostor_bytes(p.impostors, p.impostor_texels, false), 2u * 6 * 16 * 16 * 8 + 2u * 6 * 4 * 8);
    EXPECT_EQ(impostor_bytes(p.impostors, p.impostor_texels, true), 2u * 2 * 6 * 16 * 16 * 8 + 2u * 6 * 4 * 8);
}

} // namespace
} // namespace gi::test
