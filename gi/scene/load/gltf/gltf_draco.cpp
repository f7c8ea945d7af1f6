#include "gi/scene/load/gltf/gltf_draco.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#include <draco/compression/decode.h>
#pragma GCC diagnostic pop
#include <fmt/format.h>

namespace gi {

DracoMesh decode_draco(GltfDocument& d, tinygltf::Primitive const& primitive, std::string const& where)
{
    tinygltf::Value const& extension = primitive.extensions.at("KHR_draco_mesh_compression");
    auto const bad = [&](std::string const& why) {
        return d.error(where + " cannot be decompressed (KHR_draco_mesh_compression)", why);
    };
    if (!extension.IsObject() || !extension.Has("bufferView") || !extension.Get("bufferView").IsInt() ||
        !extension.Has("attributes") || !extension.Get("attributes").IsObject())
        throw bad("it has no buffer view or no attributes");
    Bytes const bytes = d.view_bytes(extension.Get("bufferView").GetNumberAsInt());

    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<char const*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    std::unique_ptr<draco::Mesh> mesh;
    try {
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) throw bad(decoded.status().error_msg_string());
        mesh = std::move(decoded).value();
    } catch (std::bad_alloc const&) {
        throw bad("it asks for more memory than is available");
    } catch (std::length_error const&) {
        throw bad("it asks for more memory than is available");
    }

    DracoMesh out;
    std::uint32_t const points = mesh->num_points();
    out.triangles.reserve(mesh->num_faces());
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
        draco::Mesh::Face const& face = mesh->face(f);
        out.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
    }
    tinygltf::Value const& ids = extension.Get("attributes");
    for (std::string const& name : ids.Keys()) {
        if (!ids.Get(name).IsInt()) throw bad("the id of " + name + " is not an integer");
        auto const id = std::uint32_t(ids.Get(name).GetNumberAsInt());
        int const number = mesh->GetAttributeIdByUniqueId(id);
        if (number < 0) throw bad(fmt::format("it has no attribute {} for {}", id, name));
        draco::PointAttribute* const attribute = mesh->attribute(number);
        if (auto const it = primitive.attributes.find(name);
            it != primitive.attributes.end() && std::size_t(it->second) < d.model.accessors.size())
            attribute->set_normalized(d.model.accessors[std::size_t(it->second)].normalized);
        GltfArray array;
        array.count = points;
        array.components = std::size_t(attribute->num_components());
        if (array.components < 1 || array.components > 4) throw bad(name + " has a wrong number of components");
        d.spend(points, name + " of " + where);
        array.values.resize(array.count * array.components);
        for (draco::PointIndex p(0); p < points; ++p) {
            draco::AttributeValueIndex const at = attribute->mapped_index(p);
            if (at.value() >= attribute->size() ||
                !attribute->ConvertValue<float>(at, std::int8_t(array.components),
                                                array.values.data() + p.value() * array.components))
                throw bad(name + " is damaged");
        }
        out.attributes[name] = std::move(array);
    }
    return out;
}

} // namespace gi
