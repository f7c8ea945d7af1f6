#include "gi/scene/model/plan.h"

#include "gi/scene/motion/motion.h"
#include "gi/scene/shading/bsdf.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

bool delta(Material const& m)
{
    return m.model == MaterialModel::metal_rough &&
           (m.transmission > 0 ||
            (m.roughness * m.roughness < kSmoothAlpha && (m.specular > 0 || m.metallic > 0)));
}

} // namespace

ScenePlan plan_scene(World const& world)
{
    ScenePlan plan;
    Scene const& scene = *world.scene;
    std::vector<bool> used(world.materials.size(), false);
    for (std::uint32_t const m : world.triangle_material) used[m] = true;
    auto const count = [&](auto const& predicate) {
        std::size_t found = 0;
        for (std::size_t i = 0; i < used.size(); ++i) found += used[i] && predicate(world.materials[i]);
        return found;
    };
    std::size_t const materials = count([](Material const&) { return true; });
    auto const decide = [&](std::string const& what, bool build, std::string const& yes, std::string const& no) {
        plan.items.push_back({what, build, build ? yes : no});
        return build;
    };
    auto const of_materials = [&](std::size_t n, std::string const& what) {
        return fmt::format("{} of {} materials {}", n, materials, what);
    };

    std::size_t const masked = count([](Material const& m) { return m.alpha_mode != AlphaMode::opaque; });
    plan.alpha_tests = decide("alpha tests along rays", masked > 0, of_materials(masked, "are masks or blend"),
                              "every material is opaque");
    EnvironmentMap const* const map = world.environment.get();
    plan.environment =
        decide("environment sampling", world.environment_pdf > 0,
               map != nullptr ? fmt::format("a map of {} x {} texels", map->width, map->height) : "",
               map != nullptr ? "the map is black" : "no environment map");
    plan.emitters = decide("emissive-triangle sampling", !world.emitters.empty(),
                           fmt::format("{} triangles emit", world.emitters.size()), "nothing emits");
    plan.punctual_lights = decide("punctual lights", !world.lights.empty(),
                                  fmt::format("{} point, spot or directional lights", world.lights.size()),
                                  "no point, spot or directional light");
    std::size_t const mirrors = count(delta);
    plan.delta_lobes = decide("delta lobes (mirrors, smooth glass)", mirrors > 0,
                              of_materials(mirrors, "are perfectly smooth"), "nothing is perfectly smooth");
    std::size_t const glass = count([](Material const& m) { return m.transmission > 0; });
    plan.transmission = decide("transmission", glass > 0, of_materials(glass, "let light through"),
                               "no material lets light through");
    std::size_t const maps = count(has_textures);
    plan.textures =
        decide("texture lookups", maps > 0, of_materials(maps, "have textures"), "no material has a texture");
    std::size_t const bumps = count([](Material const& m) { return m.normal_map.texture >= 0; });
    plan.normal_maps =
        decide("normal maps", bumps > 0, of_materials(bumps, "have one"), "no material has a normal map");
    plan.skins = decide("skinning", !scene.skins.empty(), fmt::format("{} skins", scene.skins.size()), "no skin");
    auto const morphing = std::count_if(scene.meshes.begin(), scene.meshes.end(),
                                        [](Mesh const& m) { return !m.morph_targets.empty(); });
    plan.morphs = decide("morph targets", morphing > 0, fmt::format("{} meshes have them", morphing),
                         "no mesh has morph targets");
    plan.motion = decide("motion", !scene.playbacks.empty(), fmt::format("{} clips play", scene.playbacks.size()),
                         scene.animations.empty() ? "no animation clip" : "no clip was chosen to play");
    std::size_t const moving = world.triangles.size() - world.static_triangles;
    std::vector<std::string> const reasons = reasons_for_motion(scene);
    plan.moving_parts =
        decide("updates of moving parts", moving > 0,
               fmt::format("{} of {} triangles in {} of {} instances can move: {}", moving, world.triangles.size(),
                           world.instances - world.static_instances, world.instances, fmt::join(reasons, "; ")),
               fmt::format("none of the {} triangles can move", world.triangles.size()));
    return plan;
}

} // namespace gi
