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
    auto const decide = [&](char const* name, char const* what, bool build, PlanText const& yes,
                            PlanText const& no) {
        plan.items.emplace_back(name, what, build, build ? yes : no);
        return build;
    };
    auto const of_materials = [&](std::size_t n, char const* words) {
        return PlanText(words, {figure("materials_concerned", n), figure("materials", materials)});
    };

    std::size_t const masked = count([](Material const& m) { return m.alpha_mode != AlphaMode::opaque; });
    plan.alpha_tests =
        decide("alpha_tests", "alpha tests along rays", masked > 0,
               of_materials(masked, "{} of {} materials are masks or blend"), "every material is opaque");
    EnvironmentMap const* const map = world.environment.get();
    plan.environment =
        decide("environment", "environment sampling", world.environment_pdf > 0,
               map != nullptr ? PlanText("a map of {} x {} texels",
                                         {figure("width_px", map->width), figure("height_px", map->height)})
                              : "",
               map != nullptr ? "the map is black" : "no environment map");
    plan.emitters = decide("emitters", "emissive-triangle sampling", !world.emitters.empty(),
                           {"{} triangles emit", {figure("triangles", world.emitters.size())}}, "nothing emits");
    plan.punctual_lights =
        decide("punctual_lights", "punctual lights", !world.lights.empty(),
               {"{} point, spot or directional lights", {figure("lights", world.lights.size())}},
               "no point, spot or directional light");
    std::size_t const mirrors = count(delta);
    plan.delta_lobes =
        decide("delta_lobes", "delta lobes (mirrors, smooth glass)", mirrors > 0,
               of_materials(mirrors, "{} of {} materials are perfectly smooth"), "nothing is perfectly smooth");
    std::size_t const glass = count([](Material const& m) { return m.transmission > 0; });
    plan.transmission =
        decide("transmission", "transmission", glass > 0,
               of_materials(glass, "{} of {} materials let light through"), "no material lets light through");
    std::size_t const maps = count(has_textures);
    plan.textures = decide("textures", "texture lookups", maps > 0,
                           of_materials(maps, "{} of {} materials have textures"), "no material has a texture");
    std::size_t const bumps = count([](Material const& m) { return m.normal_map.texture >= 0; });
    plan.normal_maps = decide("normal_maps", "normal maps", bumps > 0,
                              of_materials(bumps, "{} of {} materials have one"), "no material has a normal map");
    plan.skins = decide("skinning", "skinning", !scene.skins.empty(),
                        {"{} skins", {figure("skins", scene.skins.size())}}, "no skin");
    auto const morphing = std::count_if(scene.meshes.begin(), scene.meshes.end(),
                                        [](Mesh const& m) { return !m.morph_targets.empty(); });
    plan.morphs = decide("morph_targets", "morph targets", morphing > 0,
                         {"{} meshes have them", {figure("meshes", morphing)}}, "no mesh has morph targets");
    plan.motion = decide("motion", "motion", !scene.playbacks.empty(),
                         {"{} clips play", {figure("clips", scene.playbacks.size())}},
                         scene.animations.empty() ? "no animation clip" : "no clip was chosen to play");
    std::size_t const triangles = world.triangles.size(), moving = triangles - world.static_triangles;
    PlanText const what_moves("{} of {} triangles in {} of {} instances can move: ",
                              {figure("moving_triangles", moving), figure("triangles", triangles),
                               figure("moving_instances", world.instances - world.static_instances),
                               figure("instances", world.instances)});
    plan.moving_parts = decide("moving_parts", "updates of moving parts", moving > 0,
                               what_moves + fmt::format("{}", fmt::join(reasons_for_motion(scene), "; ")),
                               {"none of the {} triangles can move", {figure("triangles", triangles)}});
    return plan;
}

} // namespace gi
