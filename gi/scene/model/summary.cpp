#include "gi/scene/model/summary.h"

#include "gi/scene/shading/bsdf.h"
#include "gi/scene/shading/environment_harmonics.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace gi {
namespace {

MaterialKinds material_kinds(Scene const& scene)
{
    MaterialKinds k;
    k.all = scene.materials.size();
    for (Material const& m : scene.materials) {
        k.emitting += emits(m);
        if (m.model == MaterialModel::phong)
            ++k.phong;
        else if (m.transmission > 0)
            ++k.glass;
        else if (m.metallic > 0.5f)
            ++(m.roughness * m.roughness < kSmoothAlpha ? k.mirror : k.metal);
        else
            ++(m.specular > 0 ? k.coated : k.matt);
    }
    return k;
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

/// Harmonics only find the brightest normal.
EnvironmentSummary summarise_environment(World const& world)
{
    EnvironmentHarmonics const h = project(world, EnvironmentHarmonics::kMostDegree);
    dvec3 const normals[] = {{0, 1, 0}, {0, -1, 0}, brightest_normal(h)};
    std::vector<dvec3> const e = integrate_irradiance(world, normals);
    return {world.environment->width, world.environment->height, e[0], e[1], e[2], normals[2], h.energy_share(2)};
}

template <class Items, class Text>
std::string join(Items const& items, Text const& text)
{
    std::string out;
    for (auto const& item : items) out += (out.empty() ? "" : ", ") + text(item);
    return out.empty() ? "none" : out;
}

std::string numbered(SceneSummary const& s, std::size_t material)
{
    std::string const& name = s.material_names[material];
    return name.empty() ? std::to_string(material) : fmt::format("{} '{}'", material, name);
}

/// "0 point at 1, 2, 3 m", for the first few.
std::string places(std::vector<LightSummary> const& lights)
{
    constexpr std::size_t kMost = 12;
    std::string out = std::to_string(lights.size());
    for (std::size_t i = 0; i < std::min(lights.size(), kMost); ++i) {
        LightSummary const& l = lights[i];
        dvec3 const p = l.position_m, d = l.direction;
        out += fmt::format("{} {} ", i == 0 ? ":" : ";", i);
        out += l.type == LightType::directional
                   ? fmt::format("directional, shines along {:.3g}, {:.3g}, {:.3g}", d.x, d.y, d.z)
                   : fmt::format("{} at {:.6g}, {:.6g}, {:.6g} m", l.type == LightType::spot ? "spot" : "point",
                                 p.x, p.y, p.z);
    }
    return lights.size() > kMost ? out + fmt::format("; and {} more (--json)", lights.size() - kMost) : out;
}

/// "0 'floor', 1 'wall'", for the first few.
std::string names(SceneSummary const& s, std::vector<std::size_t> const& materials)
{
    constexpr std::size_t kMost = 24;
    std::string out;
    for (std::size_t i = 0; i < std::min(materials.size(), kMost); ++i)
        out += (i == 0 ? "" : ", ") + numbered(s, materials[i]);
    return materials.size() > kMost ? out + fmt::format(" and {} more (--json)", materials.size() - kMost) : out;
}

} // namespace

SceneSummary summarise(World const& world)
{
    Scene const& scene = *world.scene;
    SceneSummary s;
    s.nodes = scene.nodes.size();
    s.meshes = scene.meshes.size();
    s.placed_meshes = world.instances;
    s.triangles = world.triangles.size();
    s.vertices = world.positions.size();
    if (!world.bounds.empty())
        s.bounds_m = {dvec3(world.bounds.low) + world.origin, dvec3(world.bounds.high) + world.origin};
    s.materials = material_kinds(scene);
    s.material_names = scene.material_names;
    s.material_names.resize(scene.materials.size());
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (emits(scene.materials[m])) s.emitting_materials.push_back(m);
    for (Light const& l : world.lights)
        s.lights.push_back({l.type, dvec3(l.position) + world.origin, dvec3(l.direction)});
    s.textures = scene.textures.textures.size();
    s.texture_bytes = scene.textures.texels.size() * sizeof(Rgba8);
    s.punctual_lights = world.lights.size();
    s.emissive_triangles = world.emitters.size();
    s.emissive_area_m2 = emitting_area(world);
    if (world.environment) s.environment = summarise_environment(world);
    for (Camera const& c : world.cameras) s.cameras.push_back({c.name, c.aperture_radius_m, c.focus_distance_m});
    for (Skin const& k : scene.skins) s.skin_joints.push_back(k.joints.size());
    for (Mesh const& m : scene.meshes) s.morph_targets += m.morph_targets.size();
    for (Animation const& a : scene.animations) {
        s.clips.push_back({a.name, a.duration_s});
        if (!a.channels.empty() && a.channels[0].path == ChannelPath::morph_frame)
            s.mesh_sequences.push_back(
                {a.name, scene.nodes[std::size_t(a.channels[0].node)].morph_weights.size() + 1});
    }
    for (Playback const& p : scene.playbacks)
        s.playing.push_back({scene.animations[std::size_t(p.animation)].name, double(p.weight)});
    return s;
}

std::vector<SummaryLine> text_lines(SceneSummary const& s)
{
    std::vector<SummaryLine> lines;
    auto const add = [&](char const* what, std::string const& value) { lines.push_back({what, value}); };
    add("nodes", std::to_string(s.nodes));
    add("meshes", fmt::format("{} ({} placed)", s.meshes, s.placed_meshes));
    add("triangles", std::to_string(s.triangles));
    add("vertices", std::to_string(s.vertices));
    if (s.bounds_m) {
        auto const& [low, high] = *s.bounds_m;
        double const far = glm::length(high + low) / std::max(glm::length(high - low), 1e-30);
        int const digits = far > 1000 ? 10 : 6;
        add("bounds", fmt::format("{:.{}g}, {:.{}g}, {:.{}g} to {:.{}g}, {:.{}g}, {:.{}g} m", low.x, digits, low.y,
                                  digits, low.z, digits, high.x, digits, high.y, digits, high.z, digits));
    }
    MaterialKinds const& k = s.materials;
    add("materials", fmt::format("{} ({} matt, {} coated, {} Phong, {} metal, {} mirror, {} glass; {} emit)",
                                 k.all, k.matt, k.coated, k.phong, k.metal, k.mirror, k.glass, k.emitting));
    std::vector<std::size_t> all(s.material_names.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    if (!all.empty()) add("their names", names(s, all));
    add("textures", fmt::format("{} ({:.1f} MiB)", s.textures, double(s.texture_bytes) / (1 << 20)));
    add("punctual lights", places(s.lights));
    add("emissive triangles",
        fmt::format("{} ({:.6g} m2{}{})", s.emissive_triangles, s.emissive_area_m2,
                    s.emitting_materials.empty() ? "" : "; materials ", names(s, s.emitting_materials)));
    add("environment map",
        s.environment ? fmt::format("{} x {}", s.environment->width, s.environment->height) : "none");
    if (auto const& e = s.environment) {
        auto const rgb = [](dvec3 v) { return fmt::format("{:.4g}, {:.4g}, {:.4g} W/m2", v.x, v.y, v.z); };
        dvec3 const n = e->brightest_normal;
        add("light on upward faces", rgb(e->up));
        add("on downward faces", rgb(e->down));
        add("on the brightest",
            fmt::format("{}, facing {:.2f}, {:.2f}, {:.2f}", rgb(e->brightest), n.x, n.y, n.z));
        add("smooth part of the map",
            fmt::format("{:.3g} % of its squared radiance (spherical harmonics to degree 2)",
                        100 * e->smooth_share));
    }
    add("cameras", join(s.cameras, [](CameraSummary const& c) {
            if (c.aperture_radius_m == 0) return c.name;
            return fmt::format("{} (lens of {:.3g} m radius, focus at {:.3g} m)", c.name, c.aperture_radius_m,
                               c.focus_distance_m);
        }));
    add("skins", join(s.skin_joints, [](std::size_t joints) { return fmt::format("{} joints", joints); }));
    add("morph targets", std::to_string(s.morph_targets));
    for (MeshSequenceSummary const& m : s.mesh_sequences)
        add("mesh sequence", fmt::format("{} ({} frames)", m.name, m.frames));
    add("clips",
        join(s.clips, [](ClipSummary const& c) { return fmt::format("{} ({:.3g} s)", c.name, c.duration_s); }));
    add("playing", join(s.playing, [](PlayingClip const& p) {
            return p.weight == 1 ? p.name : fmt::format("{} (weight {:g})", p.name, p.weight);
        }));
    return lines;
}

} // namespace gi
