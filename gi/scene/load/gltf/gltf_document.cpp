#include "gi/scene/load/gltf/gltf_document.h"

#include "gi/core/base64.h"
#include "gi/core/file.h"
#include "gi/scene/load/gltf/gltf_meshopt.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace gi {
namespace {

using nlohmann::json;

constexpr int kDeepestJson = 64; ///< maximum nesting of JSON; deeper files would exhaust the parser's stack

constexpr std::array<std::string_view, 16> kKnownExtensions{
    "KHR_draco_mesh_compression", "KHR_lights_punctual",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular", "KHR_materials_transmission",
    "KHR_materials_volume",       "KHR_materials_unlit",    "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization",      "KHR_texture_transform",  "EXT_meshopt_compression",
    "EXT_texture_webp",           "KHR_materials_variants", "KHR_xmp_json_ld",
    "KHR_node_visibility"};

struct Container {
    Bytes text, binary;
};

/// Decodes percent escapes of a URI: %41 becomes A; text that is not an escape stays.
std::string decode_percent(std::string_view text)
{
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned value = 0;
        if (text[i] == '%' && i + 2 < text.size()) {
            char const* const first = text.data() + i + 1;
            if (std::from_chars(first, first + 2, value, 16).ptr == first + 2) {
                out += char(value);
                i += 2;
                continue;
            }
        }
        out += text[i];
    }
    return out;
}

std::uint32_t read_u32(Bytes b, std::size_t at)
{
    std::uint32_t v;
    std::memcpy(&v, b.data() + at, 4);
    return v;
}

Container open_container(Bytes bytes, GltfDocument const& d)
{
    if (bytes.empty()) throw d.error("is empty", "there is nothing to load");
    if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) return {bytes, {}};
    if (bytes.size() < 20) throw d.error("is truncated", "a GLB header has 20 bytes");
    if (read_u32(bytes, 4) != 2) throw d.error("is not GLB version 2", "other versions have a different layout");
    std::size_t const total = read_u32(bytes, 8);
    if (total > bytes.size())
        throw d.error("is truncated", fmt::format("its header states {} bytes, it has {}", total, bytes.size()));
    Container c;
    for (std::size_t at = 12; at + 8 <= total;) {
        std::size_t const length = read_u32(bytes, at);
        std::uint32_t const type = read_u32(bytes, at + 4);
        if (length > total - at - 8)
            throw d.error("is truncated", fmt::format("a chunk at byte {} reaches beyond the end", at));
        Bytes const chunk = bytes.subspan(at + 8, length);
        if (at == 12 && type != 0x4e4f534a) throw d.error("is damaged", "its first chunk is not JSON");
        if (type == 0x4e4f534a && c.text.empty()) c.text = chunk;
        if (type == 0x004e4942 && c.binary.empty()) c.binary = chunk;
        at += 8 + length;
    }
    return c;
}

void check_depth(Bytes text, GltfDocument const& d)
{
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned char const c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            quoted = c != '"';
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kDeepestJson)
                throw d.error("nests too deeply", fmt::format("more than {} levels of JSON", kDeepestJson));
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

json parse_json(Bytes text, GltfDocument const& d)
{
    check_depth(text, d);
    try {
        json j = json::parse(text.begin(), text.end());
        if (!j.is_object()) throw d.error("is not glTF", "its JSON is not an object");
        return j;
    } catch (json::parse_error const& e) {
        auto const end = text.begin() + std::ptrdiff_t(std::min(e.byte, text.size()));
        int const line = 1 + int(std::count(text.begin(), end, '\n'));
        auto const start = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
        throw InputError({d.name, line, int(end - start)}, "is not valid JSON", e.what(),
                         "correct that place, or copy the file again if it was cut off");
    } catch (json::exception const& e) { // e.g. a number outside the range of double
        throw d.error("is not valid JSON", e.what());
    }
}

/// Returns -1 if the member is missing or not a usable index.
std::int64_t index_member(json const& object, char const* key)
{
    auto const it = object.find(key);
    if (it == object.end() || !it->is_number_integer() ||
        (it->is_number_unsigned() && it->get<std::uint64_t>() >> 62))
        return -1;
    return it->get<std::int64_t>();
}

/// Changes 3.0 to 3: the two are the same in JSON, but not for tinygltf.
void make_whole_numbers_integers(json& j)
{
    if (j.is_structured()) {
        for (json& item : j) make_whole_numbers_integers(item);
    } else if (j.is_number_float()) {
        double const v = j.get<double>();
        if (std::abs(v) < 0x1p53 && v == std::floor(v)) j = std::int64_t(v);
    }
}

/// Removes and returns the indices of all primitives, -1 = none, because tinygltf rejects indices without a buffer
/// view, which are valid with Draco compression.
std::vector<std::vector<int>> take_indices(json& root)
{
    std::vector<std::vector<int>> taken;
    auto const meshes = root.find("meshes");
    if (meshes == root.end() || !meshes->is_array()) return taken;
    for (json& mesh : *meshes) {
        taken.emplace_back();
        if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
        for (json& primitive : mesh["primitives"]) {
            taken.back().push_back(-1);
            if (!primitive.is_object() || !primitive.contains("indices")) continue;
            std::int64_t const index = index_member(primitive, "indices");
            bool const usable = index >= 0 && index < (1 << 30);
            taken.back().back() = usable ? int(index) : 1 << 30; // exists in no file: an error later on
            primitive.erase("indices");
        }
    }
    return taken;
}

/// Removes and returns an array member of the root; null if it does not exist.
json take(json& root, char const* key, GltfDocument const& d)
{
    auto const it = root.find(key);
    if (it == root.end()) return json::array();
    json taken = std::move(*it);
    root.erase(it);
    if (!taken.is_array()) throw d.error(fmt::format("has no list '{}'", key), "it has another type");
    for (json const& item : taken)
        if (!item.is_object()) throw d.error(fmt::format("has a bad item in '{}'", key), "it is not an object");
    return taken;
}

std::string text_member(json const& object, char const* key)
{
    auto const it = object.find(key);
    return it != object.end() && it->is_string() ? it->get<std::string>() : std::string();
}

std::vector<unsigned char> decode_data_uri(std::string const& uri, std::string const& what, GltfDocument const& d)
{
    auto const comma = uri.find(',');
    if (comma == std::string::npos) throw d.error(what + " has an unreadable data URI", "it has no data");
    if (uri.rfind(";base64", comma) == std::string::npos) {
        std::string const plain = decode_percent(std::string_view(uri).substr(comma + 1));
        return {plain.begin(), plain.end()};
    }
    auto bytes = decode_base64(std::string_view(uri).substr(comma + 1));
    if (!bytes) throw d.error(what + " has an unreadable data URI", "it is not base64");
    return std::move(*bytes);
}

std::vector<unsigned char> read_other_file(std::string const& uri, std::filesystem::path const& folder,
                                           std::string const& what, GltfDocument& d)
{
    if (folder.empty())
        throw d.error(fmt::format("{} is in another file, '{}'", what, uri), "other files cannot be read here");
    std::filesystem::path const file = decode_percent(uri);
    if (file.is_absolute() || uri.find("://") != std::string::npos)
        throw d.error(fmt::format("{} is at '{}'", what, uri), "only files beside the scene are read");
    try {
        std::vector<unsigned char> bytes = read_bytes(folder / file);
        d.files.push_back((folder / file).string());
        return bytes;
    } catch (InputError const& e) {
        throw d.error(fmt::format("{} is in another file, '{}'", what, uri), e.what());
    }
}

void open_buffers(GltfDocument& d, json const& list, Bytes binary, std::filesystem::path const& folder)
{
    for (std::size_t i = 0; i < list.size(); ++i) {
        std::string const what = fmt::format("buffer {}", i);
        std::int64_t const length = index_member(list[i], "byteLength");
        if (length < 1) throw d.error(what + " has no length", "byteLength must be at least 1");
        std::string const uri = text_member(list[i], "uri");
        Bytes bytes;
        bool given = true;
        if (uri.starts_with("data:"))
            bytes = d.own(decode_data_uri(uri, what, d));
        else if (!uri.empty())
            bytes = d.own(read_other_file(uri, folder, what, d));
        else if (i == 0 && !binary.empty())
            bytes = binary;
        else
            given = false; // a placeholder, e.g. for compressed data: an error only if it is used
        if (given && std::uint64_t(length) > bytes.size())
            throw d.error(what + " is truncated",
                          fmt::format("it should have {} bytes and has {}", length, bytes.size()));
        d.buffers.push_back(bytes.empty() ? bytes : bytes.first(std::size_t(length)));
        d.file_bytes += uri.empty() ? 0 : bytes.size();
    }
}

void check_views(GltfDocument& d)
{
    for (std::size_t i = 0; i < d.model.bufferViews.size(); ++i) {
        tinygltf::BufferView const& v = d.model.bufferViews[i];
        bool const placeholder =
            v.buffer >= 0 && std::size_t(v.buffer) < d.buffers.size() && d.buffers[std::size_t(v.buffer)].empty();
        if (!placeholder && !v.extensions.contains("EXT_meshopt_compression")) d.view_bytes(int(i));
    }
}

void open_images(GltfDocument& d, json const& list, std::filesystem::path const& folder, Report& report)
{
    for (std::size_t i = 0; i < list.size(); ++i) {
        GltfImage image;
        std::string const uri = text_member(list[i], "uri");
        image.name = text_member(list[i], "name");
        if (image.name.empty())
            image.name = uri.empty() || uri.starts_with("data:") ? fmt::format("image {}", i) : uri;
        std::int64_t const view = index_member(list[i], "bufferView");
        try {
            if (uri.starts_with("data:"))
                image.bytes = d.own(decode_data_uri(uri, image.name, d));
            else if (!uri.empty())
                image.bytes = d.own(read_other_file(uri, folder, image.name, d));
            else if (view >= 0 && view < std::int64_t(d.model.bufferViews.size()))
                image.bytes = d.view_bytes(int(view));
            else
                throw d.error(image.name + " has no source", "it has neither a URI nor a buffer view");
        } catch (InputError const& e) {
            report.lose("textures that could not be read", 1, e.what());
        }
        d.images.push_back(image);
    }
}

void restore_indices(GltfDocument& d, std::vector<std::vector<int>> const& indices)
{
    for (std::size_t m = 0; m < d.model.meshes.size(); ++m) {
        auto& primitives = d.model.meshes[m].primitives;
        if (m >= indices.size() || primitives.size() != indices[m].size())
            throw d.error(fmt::format("a primitive of mesh {} is not valid", m), "it has no attributes");
        for (std::size_t p = 0; p < primitives.size(); ++p) primitives[p].indices = indices[m][p];
    }
}

void check_extensions(GltfDocument const& d, Report& report)
{
    auto const known = [](std::string const& e) {
        return std::find(kKnownExtensions.begin(), kKnownExtensions.end(), e) != kKnownExtensions.end();
    };
    for (std::string const& e : d.model.extensionsRequired)
        if (!known(e)) throw d.error("needs the extension " + e, "it is not supported");
    for (std::string const& e : d.model.extensionsUsed)
        if (!known(e)) report.lose("glTF extensions ignored", 1, e);
}

} // namespace

void GltfDocument::spend(std::size_t elements, std::string const& what)
{
    std::size_t const limit = (std::size_t(1) << 22) + 64 * file_bytes;
    if (elements > limit || elements_read > limit - elements)
        throw error(what + " cannot be read",
                    fmt::format("{} elements are too many for a file of {} bytes", elements, file_bytes));
    elements_read += elements;
}

Bytes GltfDocument::view_bytes(int index)
{
    if (index < 0 || std::size_t(index) >= model.bufferViews.size())
        throw error(fmt::format("buffer view {} does not exist", index), "the file refers to it");
    if (auto const it = decoded_views.find(index); it != decoded_views.end()) return it->second;
    tinygltf::BufferView const& v = model.bufferViews[std::size_t(index)];
    if (auto const extension = v.extensions.find("EXT_meshopt_compression"); extension != v.extensions.end())
        return decoded_views[index] = own(decode_meshopt(*this, index, extension->second));
    if (v.buffer < 0 || std::size_t(v.buffer) >= buffers.size())
        throw error(fmt::format("buffer {} does not exist", v.buffer),
                    fmt::format("buffer view {} needs it", index));
    Bytes const buffer = buffers[std::size_t(v.buffer)];
    if (v.byteLength > buffer.size() || v.byteOffset > buffer.size() - v.byteLength)
        throw error(fmt::format("buffer view {} lies outside its buffer", index),
                    fmt::format("{} + {} bytes of {}", v.byteOffset, v.byteLength, buffer.size()));
    return buffer.subspan(v.byteOffset, v.byteLength);
}

GltfDocument open_gltf(Bytes bytes, std::filesystem::path const& folder, std::string const& name, Report& report)
{
    GltfDocument d;
    d.name = name;
    d.file_bytes = bytes.size();
    Container const container = open_container(bytes, d);
    json root = parse_json(container.text, d);
    make_whole_numbers_integers(root);
    json const buffers = take(root, "buffers", d), images = take(root, "images", d);
    std::vector<std::vector<int>> const indices = take_indices(root);

    tinygltf::TinyGLTF parser;
    std::string errors, warnings;
    std::string const text = root.dump(-1, ' ', false, json::error_handler_t::replace);
    root = nullptr;
    bool parsed = false;
    try {
        parsed = parser.LoadASCIIFromString(&d.model, &errors, &warnings, text.data(), unsigned(text.size()), "");
    } catch (std::exception const& e) {
        errors = e.what();
    }
    while (errors.ends_with('\n')) errors.pop_back();
    std::replace(errors.begin(), errors.end(), '\n', ' ');
    if (!parsed) throw d.error("is not valid glTF", errors.empty() ? "the parser rejected it" : errors);
    if (!d.model.asset.version.starts_with("2."))
        throw d.error("is not glTF 2", "its asset version is '" + d.model.asset.version + "'");
    restore_indices(d, indices);
    check_extensions(d, report);
    open_buffers(d, buffers, container.binary, folder);
    check_views(d);
    open_images(d, images, folder, report);
    return d;
}

} // namespace gi
