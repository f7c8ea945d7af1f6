#include "gi/scene/load/gltf/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace gi {
namespace {

/// Maximum compression ratio: the vertex codec needs at least 2 bits for 16 equal bytes, the index codecs one byte
/// per triangle (up to 12 bytes) or index (up to 4 bytes).
constexpr std::size_t kStrongestCompression = 64;

std::size_t size_member(tinygltf::Value const& object, char const* key)
{
    if (!object.Has(key)) return 0;
    tinygltf::Value const& v = object.Get(key);
    double const number = v.IsNumber() ? v.GetNumberAsDouble() : -1;
    return number >= 0 && number < 1e15 ? std::size_t(number) : 0;
}

std::string text_member(tinygltf::Value const& object, char const* key, char const* otherwise)
{
    if (!object.Has(key) || !object.Get(key).IsString()) return otherwise;
    return object.Get(key).Get<std::string>();
}

} // namespace

std::vector<unsigned char> decode_meshopt(GltfDocument& d, int view, tinygltf::Value const& extension)
{
    auto const bad = [&](std::string const& why) {
        return d.error(fmt::format("buffer view {} cannot be decompressed (EXT_meshopt_compression)", view), why);
    };
    if (!extension.IsObject() || !extension.Has("buffer")) throw bad("it has no buffer");
    std::size_t const buffer = size_member(extension, "buffer"), offset = size_member(extension, "byteOffset"),
                      length = size_member(extension, "byteLength"), stride = size_member(extension, "byteStride"),
                      count = size_member(extension, "count");
    std::string const mode = text_member(extension, "mode", ""), filter = text_member(extension, "filter", "NONE");
    if (buffer >= d.buffers.size()) throw bad("its buffer does not exist");
    Bytes const all = d.buffers[buffer];
    if (length > all.size() || offset > all.size() - length) throw bad("it lies outside its buffer");
    if (stride < 1 || stride > 256 || count < 1 || count > length * kStrongestCompression / stride)
        throw bad("its stride or count is out of range");
    Bytes const source = all.subspan(offset, length);

    std::vector<unsigned char> out(count * stride);
    int result = -1;
    if (mode == "ATTRIBUTES") {
        if (stride % 4 != 0) throw bad("its stride is not a multiple of 4");
        result = meshopt_decodeVertexBuffer(out.data(), count, stride, source.data(), source.size());
    } else if (mode == "TRIANGLES" || mode == "INDICES") {
        if (stride != 2 && stride != 4) throw bad("its stride is neither 2 nor 4");
        if (mode == "TRIANGLES" && count % 3 != 0) throw bad("its count is not a multiple of 3");
        result = mode == "TRIANGLES"
                     ? meshopt_decodeIndexBuffer(out.data(), count, stride, source.data(), source.size())
                     : meshopt_decodeIndexSequence(out.data(), count, stride, source.data(), source.size());
    } else {
        throw bad("its mode '" + mode + "' is unknown");
    }
    if (result != 0) throw bad("the data are damaged");

    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(out.data(), count, stride);
    else if (filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(out.data(), count, stride);
    else if (filter == "EXPONENTIAL" && stride % 4 == 0)
        meshopt_decodeFilterExp(out.data(), count, stride);
    else if (filter != "NONE")
        throw bad("its filter '" + filter + "' does not fit its stride");
    return out;
}

} // namespace gi
