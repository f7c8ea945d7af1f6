#pragma once
// Small glTF files for tests: JSON that a test fills in, and one binary chunk.

#include "gi/core/report.h"
#include "gi/scene/load/load.h"

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace gi::test {

constexpr int kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125, kFloat = 5126;

struct GltfBuilder {
    nlohmann::json root{{"asset", {{"version", "2.0"}}}};
    std::vector<unsigned char> binary;

    int append(char const* list, nlohmann::json item)
    {
        root[list].push_back(std::move(item));
        return int(root[list].size()) - 1;
    }
    template <class T>
    int add_view(std::vector<T> const& values, int stride = 0)
    {
        while (binary.size() % 4 != 0) binary.push_back(0);
        nlohmann::json view{
            {"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}};
        if (stride > 0) view["byteStride"] = stride;
        auto const* const p = reinterpret_cast<unsigned char const*>(values.data());
        binary.insert(binary.end(), p, p + values.size() * sizeof(T));
        return append("bufferViews", view);
    }
    int add_accessor(int view, int component, std::size_t count, char const* type, bool normalized = false)
    {
        nlohmann::json a{{"componentType", component}, {"count", count}, {"type", type}};
        if (view >= 0) a["bufferView"] = view;
        if (normalized) a["normalized"] = true;
        return append("accessors", a);
    }
    /// @param components numbers per element
    int add_floats(std::vector<float> const& values, char const* type, std::size_t components)
    {
        return add_accessor(add_view(values), kFloat, values.size() / components, type);
    }
    /// A mesh of one primitive with these attributes, a node that holds it, a scene that shows the node.
    nlohmann::json& add_primitive(nlohmann::json const& attributes)
    {
        int const mesh = append("meshes", {{"primitives", {{{"attributes", attributes}}}}});
        int const node = append("nodes", {{"mesh", mesh}});
        root["scene"] = 0;
        if (!root.contains("scenes")) append("scenes", {{"nodes", nlohmann::json::array()}});
        root["scenes"][0]["nodes"].push_back(node);
        return root["meshes"][std::size_t(mesh)]["primitives"][0];
    }
    /// The corners (0,0,0), (1,0,0), (0,1,0).
    nlohmann::json& add_triangle()
    {
        return add_primitive({{"POSITION", add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3)}});
    }
    std::vector<unsigned char> glb() const
    {
        nlohmann::json j = root;
        if (!binary.empty() && !j.contains("buffers")) j["buffers"] = {{{"byteLength", binary.size()}}};
        std::string text = j.dump();
        while (text.size() % 4 != 0) text += ' ';
        std::vector<unsigned char> out;
        auto const word = [&](std::size_t v) {
            for (int i = 0; i < 4; ++i) out.push_back(static_cast<unsigned char>(v >> (8 * i)));
        };
        std::size_t const padded = (binary.size() + 3) / 4 * 4;
        word(0x46546c67);
        word(2);
        word(12 + 8 + text.size() + 8 + padded);
        word(text.size());
        word(0x4e4f534a);
        out.insert(out.end(), text.begin(), text.end());
        word(padded);
        word(0x004e4942);
        out.insert(out.end(), binary.begin(), binary.end());
        out.resize(out.size() + padded - binary.size());
        return out;
    }
    Scene parse(Report& report) const
    {
        std::vector<unsigned char> const bytes = glb();
        return parse_gltf(bytes.data(), bytes.size(), {}, "test.glb", report);
    }
    Scene parse() const
    {
        Report report;
        return parse(report);
    }
};

/// How often something was lost, skipped or repaired.
inline std::uint64_t lost(Report const& report, std::string const& what)
{
    auto const losses = report.losses();
    auto const it = losses.find(what);
    return it == losses.end() ? 0 : it->second.count;
}

} // namespace gi::test
