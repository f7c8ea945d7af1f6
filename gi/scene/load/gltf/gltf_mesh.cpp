#include "gi/scene/load/gltf/gltf_parts.h"

#include "gi/core/step.h"
#include "gi/scene/load/gltf/gltf_accessor.h"
#include "gi/scene/load/gltf/gltf_draco.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace gi {
namespace {

/// Removes unused vertices, because some exporters let all primitives share the vertices of the whole file.
void drop_unused_vertices(Mesh& mesh)
{
    constexpr std::uint32_t kUnused = ~0u;
    std::vector<std::uint32_t> new_index(mesh.positions.size(), kUnused), used;
    for (uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& to = new_index[t[k]];
            if (to == kUnused) {
                to = std::uint32_t(used.size());
                used.push_back(t[k]);
            }
            t[k] = to;
        }
    auto const keep = [&](auto& values) {
        if (values.empty()) return;
        std::remove_reference_t<decltype(values)> kept(used.size());
        for (std::size_t i = 0; i < used.size(); ++i) kept[i] = values[used[i]];
        values = std::move(kept);
    };
    keep(mesh.positions);
    keep(mesh.normals);
    keep(mesh.tangents);
    keep(mesh.uv0);
    keep(mesh.uv1);
    keep(mesh.colors);
    keep(mesh.alphas);
    keep(mesh.joints);
    keep(mesh.weights);
    for (MorphTarget& target : mesh.morph_targets) {
        keep(target.positions);
        keep(target.normals);
        keep(target.tangents);
    }
}

class PrimitiveReader {
public:
    PrimitiveReader(GltfDocument& d, Report& report, std::string where)
        : d_(d), report_(report), where_(std::move(where))
    {
    }

    /// Returns nothing if the primitive has no triangles.
    std::optional<Mesh> read(tinygltf::Primitive const& p)
    {
        int const mode = p.mode < 0 ? TINYGLTF_MODE_TRIANGLES : p.mode;
        if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
            mode != TINYGLTF_MODE_TRIANGLE_FAN) {
            report_.lose("points and lines skipped", 1, where_);
            return std::nullopt;
        }
        if (p.material >= 0 && std::size_t(p.material) >= d_.model.materials.size())
            throw d_.error(fmt::format("material {} does not exist", p.material), where_ + " uses it");
        if (p.extensions.contains("KHR_draco_mesh_compression")) draco_ = decode_draco(d_, p, where_);

        Mesh mesh;
        mesh.material = p.material;
        GltfArray const positions = attribute(p, "POSITION", 3);
        if (positions.count == 0) {
            report_.lose("primitives without positions skipped", 1, where_);
            return std::nullopt;
        }
        vertices_ = positions.count;
        mesh.positions.reserve(vertices_);
        for (std::size_t i = 0; i < vertices_; ++i) mesh.positions.push_back(positions.as_vec3(i));
        read_surface(p, mesh);
        read_skin(p, mesh);
        read_targets(p, mesh);
        mesh.triangles = draco_ ? draco_->triangles : triangles(indices(p), mode);
        for (uvec3 const t : mesh.triangles)
            if (std::max({t.x, t.y, t.z}) >= vertices_)
                throw d_.error(fmt::format("{} has an index out of range", where_),
                               fmt::format("it has {} vertices", vertices_));
        if (vertices_ / 2 > 3 * mesh.triangles.size()) drop_unused_vertices(mesh);
        return mesh;
    }

private:
    /// Returns an attribute; empty if the primitive does not have it. @param components 0 = any
    GltfArray attribute(tinygltf::Primitive const& p, char const* name, std::size_t components)
    {
        if (draco_)
            if (auto const it = draco_->attributes.find(name); it != draco_->attributes.end()) {
                if (components != 0 && it->second.components != components)
                    throw d_.error(fmt::format("{} of {} is damaged", name, where_), "its components do not fit");
                return check_count(it->second, name);
            }
        auto const it = p.attributes.find(name);
        if (it == p.attributes.end()) return {};
        return check_count(read_floats(d_, it->second, components), name);
    }
    GltfArray check_count(GltfArray array, char const* name) const
    {
        if (vertices_ != 0 && array.count != vertices_)
            throw d_.error(fmt::format("{} of {} has {} values", name, where_, array.count),
                           fmt::format("there are {} vertices", vertices_));
        return array;
    }

    void read_surface(tinygltf::Primitive const& p, Mesh& mesh)
    {
        std::uint64_t repaired = 0;
        GltfArray const normals = attribute(p, "NORMAL", 3);
        mesh.normals.reserve(normals.count);
        for (std::size_t i = 0; i < normals.count; ++i) {
            vec3 const n = normals.as_vec3(i);
            float const length = glm::length(n);
            bool const good = length > 1e-12f && length < kInf;
            repaired += !good || std::abs(length - 1) > 0.01f;
            mesh.normals.push_back(good ? n / length : vec3{0});
        }
        report_.lose("normals that are not unit, normalised or left flat", repaired, where_);
        // Without normals given tangents must be ignored (sec. 3.7.2.1).
        GltfArray const tangents = normals.count > 0 ? attribute(p, "TANGENT", 4) : GltfArray{};
        for (std::size_t i = 0; i < tangents.count; ++i) {
            vec4 const t = tangents.as_vec4(i);
            float const length = glm::length(vec3(t));
            bool const good = length > 1e-12f && length < kInf;
            mesh.tangents.push_back(good ? vec4(vec3(t) / length, t.w < 0 ? -1.0f : 1.0f) : vec4{0});
        }
        for (auto [name, to] : {std::pair{"TEXCOORD_0", &mesh.uv0}, std::pair{"TEXCOORD_1", &mesh.uv1}}) {
            GltfArray const uv = attribute(p, name, 2);
            to->reserve(uv.count);
            std::uint64_t bad = 0;
            for (std::size_t i = 0; i < uv.count; ++i) {
                vec2 const v = uv.as_vec2(i);
                bool const good = std::isfinite(v.x) && std::isfinite(v.y);
                bad += !good;
                to->push_back(good ? v : vec2{0});
            }
            report_.lose("texture coordinates that are not finite, 0", bad, where_);
        }
        read_colors(p, mesh);
    }

    /// Alphas are those of materials that are masks or blend; of opaque ones they are to be ignored (sec. 3.9.4).
    void read_colors(tinygltf::Primitive const& p, Mesh& mesh)
    {
        bool const has_alpha =
            p.material >= 0 && alpha_mode(d_.model.materials[std::size_t(p.material)]) != AlphaMode::opaque;
        GltfArray const colors = attribute(p, "COLOR_0", 0);
        if (colors.count > 0 && colors.components < 3)
            throw d_.error("COLOR_0 of " + where_ + " is damaged", "it has fewer than three components");
        std::uint64_t clamped = 0;
        for (std::size_t i = 0; i < colors.count; ++i) {
            vec3 const c = colors.as_vec3(i);
            mesh.colors.push_back(all_finite(c) ? glm::clamp(c, vec3{0}, vec3{1}) : vec3{1});
            bool is_clamped = mesh.colors.back() != c;
            if (has_alpha && colors.components == 4) {
                float const a = colors.as_vec4(i).w;
                mesh.alphas.push_back(std::isfinite(a) ? std::clamp(a, 0.0f, 1.0f) : 1.0f);
                is_clamped |= mesh.alphas.back() != a;
            }
            clamped += is_clamped;
        }
        if (std::ranges::all_of(mesh.alphas, [](float a) { return a == 1; })) mesh.alphas.clear();
        if (std::ranges::all_of(mesh.colors, [](vec3 c) { return c == vec3{1}; })) mesh.colors.clear();
        report_.lose("vertex colours not within 0..1, clamped", clamped, where_);
    }

    void read_skin(tinygltf::Primitive const& p, Mesh& mesh)
    {
        if (p.attributes.contains("JOINTS_1"))
            report_.lose("joints beyond the fourth of a vertex ignored", 1, where_);
        auto const joints = p.attributes.find("JOINTS_0");
        if (joints == p.attributes.end() || !p.attributes.contains("WEIGHTS_0")) return;
        std::vector<std::uint32_t> indices;
        if (GltfArray const packed = draco_ ? attribute(p, "JOINTS_0", 4) : GltfArray{}; packed.count > 0)
            for (float const v : packed.values) indices.push_back(v >= 0 && v < 65536 ? std::uint32_t(v) : 65536);
        else
            indices = read_integers(d_, joints->second, 4);
        GltfArray const weights = attribute(p, "WEIGHTS_0", 4);
        if (indices.size() != 4 * vertices_)
            throw d_.error("JOINTS_0 of " + where_ + " is damaged", "it does not have one value per vertex");
        std::uint64_t repaired = 0;
        for (std::size_t i = 0; i < vertices_; ++i) {
            vec4 w = weights.as_vec4(i);
            for (int k = 0; k < 4; ++k)
                if (!(w[k] >= 0) || !(w[k] < kInf)) w[k] = 0;
            float const sum = w.x + w.y + w.z + w.w;
            repaired += !(std::abs(sum - 1) < 0.02f);
            mesh.weights.push_back(sum > 0 ? w / sum : vec4{1, 0, 0, 0});
            std::array<std::uint16_t, 4> j{};
            for (std::size_t k = 0; k < 4; ++k) {
                if (indices[4 * i + k] > 65535)
                    throw d_.error("a joint of " + where_ + " is out of range", "joints have 16 bits");
                if (mesh.weights.back()[int(k)] > 0) j[k] = std::uint16_t(indices[4 * i + k]);
            }
            mesh.joints.push_back(j);
        }
        report_.lose("vertex weights that do not sum to one, normalised", repaired, where_);
    }

    void read_targets(tinygltf::Primitive const& p, Mesh& mesh)
    {
        for (auto const& target : p.targets) {
            MorphTarget t;
            for (auto [name, to] : {std::pair{"POSITION", &t.positions}, std::pair{"NORMAL", &t.normals},
                                    std::pair{"TANGENT", &t.tangents}}) {
                auto const it = target.find(name);
                if (it == target.end()) continue;
                GltfArray const array = check_count(read_floats(d_, it->second, 3), name);
                for (std::size_t i = 0; i < array.count; ++i) {
                    vec3 const v = array.as_vec3(i);
                    to->push_back(all_finite(v) ? v : vec3{0});
                }
            }
            for (auto const& [name, accessor] : target)
                if (name.starts_with("COLOR_") || name.starts_with("TEXCOORD_"))
                    report_.lose("morph targets of colours and texture coordinates ignored", 1, where_);
            mesh.morph_targets.push_back(std::move(t));
        }
    }

    std::vector<std::uint32_t> indices(tinygltf::Primitive const& p)
    {
        if (p.indices >= 0) return read_integers(d_, p.indices, 1);
        std::vector<std::uint32_t> all(vertices_);
        std::iota(all.begin(), all.end(), 0u);
        return all;
    }

    std::vector<uvec3> triangles(std::vector<std::uint32_t> const& i, int mode)
    {
        std::vector<uvec3> out;
        if (mode == TINYGLTF_MODE_TRIANGLES) {
            out.reserve(i.size() / 3);
            for (std::size_t k = 0; k + 2 < i.size(); k += 3) out.push_back({i[k], i[k + 1], i[k + 2]});
            report_.lose("indices left over after the last triangle", i.size() % 3, where_);
        } else {
            for (std::size_t k = 0; k + 2 < i.size(); ++k) {
                if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
                    out.push_back({i[0], i[k + 1], i[k + 2]});
                else
                    out.push_back(k % 2 == 0 ? uvec3{i[k], i[k + 1], i[k + 2]} : uvec3{i[k + 1], i[k], i[k + 2]});
            }
        }
        return out;
    }

    GltfDocument& d_;
    Report& report_;
    std::string where_;
    std::optional<DracoMesh> draco_;
    std::size_t vertices_ = 0;
};

} // namespace

std::vector<GltfMesh> read_meshes(GltfDocument& document, Scene& scene, Report& report)
{
    std::vector<GltfMesh> out;
    for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
        at_step("meshes read", m, document.model.meshes.size());
        tinygltf::Mesh const& source = document.model.meshes[m];
        std::string const name = source.name.empty() ? fmt::format("mesh {}", m) : source.name;
        GltfMesh made;
        made.morph_targets = source.primitives.empty() ? 0 : source.primitives[0].targets.size();
        for (tinygltf::Primitive const& p : source.primitives) {
            if (p.targets.size() != made.morph_targets)
                throw document.error("the primitives of mesh '" + name + "' differ in their morph targets",
                                     "they share one list of weights");
            auto mesh = PrimitiveReader(document, report, "mesh '" + name + "'").read(p);
            if (!mesh) continue;
            mesh->name = name;
            for (auto const& joints : mesh->joints)
                for (std::uint16_t const j : joints) made.joints = std::max(made.joints, j + 1u);
            made.meshes.push_back(std::int32_t(scene.meshes.size()));
            scene.meshes.push_back(std::move(*mesh));
        }
        made.weights.assign(made.morph_targets, 0.0f);
        for (std::size_t i = 0; i < std::min(made.morph_targets, source.weights.size()); ++i)
            made.weights[i] = float(source.weights[i]);
        out.push_back(std::move(made));
    }
    return out;
}

} // namespace gi
