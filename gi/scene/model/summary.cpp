#include "gi/scene/model/summary.h"

#include "gi/scene/shading/bsdf.h"
#include "gi/scene/shading/environment_harmonics.h"

#include <fmt/format.h>

namespace gi {
namespace {

std::string material_kinds(World const& world)
{
    std::size_t phong = 0, metal = 0, mirror = 0, glass = 0, matt = 0, plastic = 0, light = 0;
    for (Material const& m : world.scene->materials) {
        light += emits(m);
        if (m.model == MaterialModel::phong)
            ++phong;
        else if (m.transmission > 0)
            ++glass;
        else if (m.metallic > 0.5f)
            ++(m.roughness * m.roughness < kSmoothAlpha ? mirror : metal);
        else
            ++(m.specular > 0 ? plastic : matt);
    }
    return fmt::format("{} ({} matt, {} coated, {} Phong, {} metal, {} mirror, {} glass; {} emit)",
                       world.scene->materials.size(), matt, plastic, phong, metal, mirror, glass, light);
}

double emitting_area(World const& world)
{
    double area = 0;
    for (std::uint32_t const i : world.emitters) {
        uvec3 const t = world.triangles[i];
        dvec3 const p(world.positions[t.x]);
        area += 0.5 * glm::length(glm::cross(dvec3(world.positions[t.y]) - p, dvec3(world.positions[t.z]) - p));
    }
    return area;
}

template <class Items, class Text>
std::string join(Items const& items, Text const& text)
{
    std::string out;
    for (auto const& item : items) out += (out.empty() ? "" : ", ") + text(item);
    return out.empty() ? "none" : out;
}

/// Unshadowed irradiance from the environment, integrated numerically; harmonics only find the brightest normal.
void describe_environment(World const& world, SceneSummary& s)
{
    EnvironmentHarmonics const h = project(world, EnvironmentHarmonics::kMostDegree);
    dvec3 const normals[] = {{0, 1, 0}, {0, -1, 0}, brightest_normal(h)};
    std::vector<dvec3> const e = integrate_irradiance(world, normals);
    auto const rgb = [](dvec3 v) { return fmt::format("{:.4g}, {:.4g}, {:.4g} W/m2", v.x, v.y, v.z); };
    dvec3 const n = normals[2];
    s.lines.push_back({"light on upward faces", rgb(e[0])});
    s.lines.push_back({"on downward faces", rgb(e[1])});
    s.lines.push_back(
        {"on the brightest", fmt::format("{}, facing {:.2f}, {:.2f}, {:.2f}", rgb(e[2]), n.x, n.y, n.z)});
    s.lines.push_back({"smooth part of the map",
                       fmt::format("{:.3g} % of its squared radiance (spherical harmonics to degree 2)",
                                   100 * h.energy_share(2))});
}

} // namespace

SceneSummary summarise(World const& world)
{
    Scene const& scene = *world.scene;
    SceneSummary s;
    auto const add = [&](char const* what, std::string const& value) { s.lines.push_back({what, value}); };
    add("nodes", std::to_string(scene.nodes.size()));
    add("meshes", fmt::format("{} ({} placed)", scene.meshes.size(), world.instances));
    add("triangles", std::to_string(world.triangles.size()));
    add("vertices", std::to_string(world.positions.size()));
    if (!world.bounds.empty()) {
        dvec3 const low = dvec3(world.bounds.low) + world.origin, high = dvec3(world.bounds.high) + world.origin;
        add("bounds", fmt::format("{:.6g}, {:.6g}, {:.6g} to {:.6g}, {:.6g}, {:.6g} m", low.x, low.y, low.z,
                                  high.x, high.y, high.z));
    }
    add("materials", material_kinds(world));
    add("textures", fmt::format("{} ({:.1f} MiB)", scene.textures.textures.size(),
                                double(scene.textures.texels.size() * sizeof(Rgba8)) / (1 << 20)));
    add("punctual lights", std::to_string(world.lights.size()));
    add("emissive triangles", fmt::format("{} ({:.6g} m2)", world.emitters.size(), emitting_area(world)));
    add("environment map",
        world.environment ? fmt::format("{} x {}", world.environment->width, world.environment->height) : "none");
    if (world.environment) describe_environment(world, s);
    add("cameras", join(world.cameras, [](Camera const& c) {
            if (c.aperture_radius_m == 0) return c.name;
            return fmt::format("{} (lens of {:.3g} m radius, focus at {:.3g} m)", c.name, c.aperture_radius_m,
                               c.focus_distance_m);
        }));
    add("skins", join(scene.skins, [](Skin const& k) { return fmt::format("{} joints", k.joints.size()); }));
    std::size_t targets = 0;
    for (Mesh const& m : scene.meshes) targets += m.morph_targets.size();
    add("morph targets", std::to_string(targets));
    for (Animation const& a : scene.animations)
        if (!a.channels.empty() && a.channels[0].path == ChannelPath::morph_frame)
            add("mesh sequence",
                fmt::format("{} ({} frames)", a.name,
                            scene.nodes[std::size_t(a.channels[0].node)].morph_weights.size() + 1));
    add("clips", join(scene.animations,
                      [](Animation const& a) { return fmt::format("{} ({:.3g} s)", a.name, a.duration_s); }));
    add("playing", join(scene.playbacks, [&](Playback const& p) {
            std::string const& name = scene.animations[std::size_t(p.animation)].name;
            return p.weight == 1 ? name : fmt::format("{} (weight {:g})", name, p.weight);
        }));
    return s;
}

} // namespace gi
