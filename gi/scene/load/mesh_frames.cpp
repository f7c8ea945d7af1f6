#include "gi/scene/load/mesh_frames.h"

#include "gi/core/error.h"
#include "gi/scene/load/assimp_import.h"
#include "gi/scene/load/assimp_parts.h"

#include <cstring>
#include <fmt/format.h>
#include <unordered_map>

namespace gi {
namespace {

InputError misfit(std::filesystem::path const& file, std::string const& why)
{
    return {"'" + file.string() + "' does not match its sequence", why,
            "export all frames from one mesh, with the same settings"};
}

MeshFrame read_mesh(aiMesh const& source, std::filesystem::path const& file)
{
    MeshFrame mesh;
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        mesh.positions.push_back(to_vec3(source.mVertices[i]));
        if (!all_finite(mesh.positions.back())) throw misfit(file, fmt::format("its vertex {} is not finite", i));
    }
    for (unsigned i = 0; source.HasNormals() && i < source.mNumVertices; ++i) {
        vec3 const v = to_vec3(source.mNormals[i]);
        float const length = glm::length(v);
        mesh.normals.push_back(length > 1e-12f && length < kInf ? v / length : vec3{0});
    }
    return mesh;
}

} // namespace

SequenceFrame read_sequence_frame(std::filesystem::path const& file)
{
    SequenceFrame frame;
    ImportedFiles const files = import_assimp(file, AssimpFaces::polygons, [&](aiScene const& scene) {
        for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
            aiMesh const& mesh = *scene.mMeshes[m];
            frame.meshes.push_back(read_mesh(mesh, file));
            std::vector<std::uint32_t>& polygons = frame.polygons.emplace_back();
            for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
                aiFace const& face = mesh.mFaces[f];
                polygons.push_back(face.mNumIndices);
                polygons.insert(polygons.end(), face.mIndices, face.mIndices + face.mNumIndices);
            }
        }
    });
    for (MeshFrame& mesh : frame.meshes) // frames may be counted from several origins, their meshes are not
        for (vec3& p : mesh.positions) p = vec3(dvec3(p) + files.origin_m);
    frame.files.assign(files.opened.begin(), files.opened.end());
    return frame;
}

void check_topology(SequenceFrame const& first, std::filesystem::path const& first_file,
                    SequenceFrame const& frame, std::filesystem::path const& file)
{
    std::string const other = "'" + first_file.filename().string() + "'";
    if (frame.meshes.size() != first.meshes.size())
        throw misfit(file,
                     fmt::format("it has {} meshes, {} has {}", frame.meshes.size(), other, first.meshes.size()));
    for (std::size_t m = 0; m < frame.meshes.size(); ++m) {
        std::size_t const vertices = frame.meshes[m].positions.size(), expected = first.meshes[m].positions.size();
        if (vertices != expected)
            throw misfit(file, fmt::format("it has {} vertices, {} has {}", vertices, other, expected));
        if (frame.polygons[m] != first.polygons[m])
            throw misfit(file, fmt::format("its faces are not those of {}", other));
    }
}

std::vector<std::uint32_t> first_equal_vertices(std::size_t count, std::vector<VertexBytes> const& attributes)
{
    auto const hash_of = [&](std::size_t vertex) { // FNV-1a
        std::uint64_t hash = 14695981039346656037u;
        for (VertexBytes const& a : attributes)
            for (std::size_t i = 0; i < a.size; ++i) hash = (hash ^ a.data[vertex * a.size + i]) * 1099511628211u;
        return hash;
    };
    auto const equal = [&](std::size_t x, std::size_t y) {
        for (VertexBytes const& a : attributes)
            if (std::memcmp(a.data + x * a.size, a.data + y * a.size, a.size) != 0) return false;
        return true;
    };
    std::unordered_multimap<std::uint64_t, std::uint32_t> seen;
    std::vector<std::uint32_t> first(count);
    for (std::size_t v = 0; v < count; ++v) {
        first[v] = std::uint32_t(v);
        std::uint64_t const hash = hash_of(v);
        auto const [begin, end] = seen.equal_range(hash);
        for (auto it = begin; it != end && first[v] == v; ++it)
            if (equal(it->second, v)) first[v] = it->second;
        if (first[v] == v) seen.emplace(hash, std::uint32_t(v));
    }
    return first;
}

void join_equal_vertices(Mesh& mesh)
{
    std::vector<VertexBytes> attributes;
    auto const for_attributes = [&](auto const& use) {
        use(mesh.positions);
        use(mesh.normals);
        use(mesh.tangents);
        use(mesh.uv0);
        use(mesh.uv1);
        use(mesh.colors);
        use(mesh.joints);
        use(mesh.weights);
    };
    for_attributes([&](auto const& a) {
        if (!a.empty()) attributes.push_back({reinterpret_cast<unsigned char const*>(a.data()), sizeof a[0]});
    });
    std::vector<std::uint32_t> const first = first_equal_vertices(mesh.positions.size(), attributes);
    std::vector<std::uint32_t> place(first.size());
    std::uint32_t kept = 0;
    for (std::uint32_t v = 0; v < first.size(); ++v) place[v] = first[v] == v ? kept++ : place[first[v]];
    for_attributes([&](auto& a) {
        if (a.empty()) return;
        for (std::uint32_t v = 0; v < first.size(); ++v) a[place[v]] = a[v];
        a.resize(kept);
    });
    for (uvec3& t : mesh.triangles) t = {place[t.x], place[t.y], place[t.z]};
}

} // namespace gi
