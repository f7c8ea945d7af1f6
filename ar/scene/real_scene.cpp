#include "ar/scene/real_scene.h"

#include "ar/scene/proxy_mesh.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/load.h"

#include <algorithm>
#include <fmt/format.h>

namespace ar {
namespace {

/// Matt grey placeholder material.
void make_unknown(gi::Material& m)
{
    m.base_color = gi::vec3(0.5f);
    m.base_color_map = {};
}

AlbedoPatch patch_of(Proxy const& p, std::size_t material)
{
    AlbedoPatch patch{p.name, material};
    if (p.surface.from != AlbedoFrom::estimate_texture) return patch;
    patch.texels = p.surface.texels;
    if (auto const* const plane = std::get_if<ProxyPlane>(&p.shape)) {
        patch.width_m = glm::length(plane->edge_u_m);
        patch.height_m = glm::length(plane->edge_v_m);
    }
    return patch;
}

void add_scene_file(RealPlace const& real, RealScene& out, gi::Report& report)
{
    if (real.scene.empty()) return;
    gi::Scene file = gi::load_scene(real.scene.string(), report);
    if (real.estimate_scene) {
        for (gi::Mesh& m : file.meshes) {
            m.colors.clear();
            if (m.material >= 0) continue;
            m.material = std::int32_t(file.materials.size());
            file.materials.emplace_back();
            file.material_names.push_back(fmt::format("of mesh {}", m.name));
        }
        for (std::size_t k = 0; k < file.materials.size(); ++k) {
            if (gi::emits(file.materials[k]) || file.materials[k].metallic > 0 ||
                file.materials[k].transmission > 0) {
                report.lose("materials of the real scene whose albedo is not estimated: metal, glass, lamps", 1,
                            file.material_names[k]);
                continue;
            }
            make_unknown(file.materials[k]);
            std::string name = "scene:" + file.material_names[k];
            auto const is_taken = [&] {
                return std::any_of(out.patches.begin(), out.patches.end(),
                                   [&](AlbedoPatch const& p) { return p.name == name; });
            };
            while (is_taken()) name += "'";
            out.patches.push_back({name, k});
        }
    }
    gi::append(out.scene, std::move(file), "real", placement(real));
}

} // namespace

RealScene model_of(RealPlace const& real, gi::Report& report)
{
    RealScene out;
    add_scene_file(real, out, report);
    for (Proxy const& p : real.proxies) {
        bool const is_estimated =
            p.surface.from == AlbedoFrom::estimate || p.surface.from == AlbedoFrom::estimate_texture;
        if (is_estimated) out.patches.push_back(patch_of(p, out.scene.materials.size()));
        gi::append(out.scene, scene_of(p, report), p.name, gi::dmat4(1));
        if (is_estimated) make_unknown(out.scene.materials.back());
    }
    return out;
}

void take_albedos(RealScene& real, std::vector<AlbedoEntry> const& entries, std::filesystem::path const& file,
                  gi::Report& report)
{
    for (AlbedoPatch const& patch : real.patches) {
        auto const found = std::find_if(entries.begin(), entries.end(),
                                        [&](AlbedoEntry const& e) { return e.name == patch.name; });
        if (found == entries.end())
            throw gi::InputError("'" + file.string() + "' does not know '" + patch.name + "'",
                                 "its albedo is to be estimated", "run lightwell ar albedo again");
        gi::Material& m = real.scene.materials[patch.material];
        m.base_color = gi::vec3(found->albedo);
        if (patch.texels > 0 && !found->texture.empty()) {
            auto const bytes = gi::read_bytes(found->texture, std::size_t(1) << 30);
            m.base_color = gi::vec3(1);
            m.base_color_map.texture =
                gi::add_texture(real.scene.textures, bytes.data(), bytes.size(), true, found->texture.string());
            gi::Texture& t = real.scene.textures.textures.back();
            t.wrap_u = t.wrap_v = gi::Wrap::clamp;
        }
        if (found->samples == 0) report.lose("surfaces whose albedo no frame has shown: grey", 1, patch.name);
    }
}

gi::Scene real_scene(RealPlace const& real, gi::Report& report)
{
    RealScene model = model_of(real, report);
    if (model.patches.empty()) return std::move(model.scene);
    if (!std::filesystem::exists(real.estimates))
        throw gi::InputError("there is no '" + real.estimates.string() + "'",
                             fmt::format("albedos of {} surfaces are to be estimated", model.patches.size()),
                             "run lightwell ar albedo on the session first");
    take_albedos(model, read_albedos(real.estimates), real.estimates, report);
    return std::move(model.scene);
}

} // namespace ar
