#include "gi/scene/load/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <utility>

namespace gi {
namespace {

struct ElementLayout {
    std::size_t components, component_bytes, columns, column_bytes;
    std::size_t bytes() const { return columns * column_bytes; }
};

/// Columns of matrices are aligned to four bytes (glTF 2, sec. 3.6.2.4).
ElementLayout element_layout(tinygltf::Accessor const& a)
{
    std::int32_t const component_bytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(a.componentType));
    std::int32_t const components = tinygltf::GetNumComponentsInType(std::uint32_t(a.type));
    if (component_bytes < 1 || components < 1 || a.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE) return {};
    ElementLayout l{std::size_t(components), std::size_t(component_bytes), 1, 0};
    std::size_t const side = a.type == TINYGLTF_TYPE_MAT2 ? 2 : a.type == TINYGLTF_TYPE_MAT3 ? 3 : 4;
    bool const matrix = a.type >= TINYGLTF_TYPE_MAT2 && a.type <= TINYGLTF_TYPE_MAT4;
    if (matrix) l.columns = side;
    l.column_bytes = l.components / l.columns * l.component_bytes;
    if (matrix) l.column_bytes = (l.column_bytes + 3) / 4 * 4;
    return l;
}

template <class T>
T load(unsigned char const* p)
{
    T v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

float to_float(unsigned char const* p, int type, bool normalized)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return load<float>(p);
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
        float const v = float(load<std::int8_t>(p));
        return normalized ? std::max(v / 127, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return float(*p) * (normalized ? 1.0f / 255 : 1.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
        float const v = float(load<std::int16_t>(p));
        return normalized ? std::max(v / 32767, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return float(load<std::uint16_t>(p)) * (normalized ? 1.0f / 65535 : 1.0f);
    case TINYGLTF_COMPONENT_TYPE_INT:
        return float(load<std::int32_t>(p));
    default:
        return float(load<std::uint32_t>(p));
    }
}

std::uint32_t to_integer(unsigned char const* p, std::size_t bytes)
{
    return bytes == 1 ? *p : bytes == 2 ? load<std::uint16_t>(p) : load<std::uint32_t>(p);
}

/// Iterates over the elements of an accessor after checking that all its bytes exist.
class AccessorReader {
public:
    AccessorReader(GltfDocument& d, int index) : d_(d), index_(index)
    {
        if (index < 0 || std::size_t(index) >= d.model.accessors.size())
            throw d.error(fmt::format("accessor {} does not exist", index), "the file refers to it");
        accessor_ = &d.model.accessors[std::size_t(index)];
        layout_ = element_layout(*accessor_);
        if (layout_.components == 0) throw bad("its type is unknown");
        if (accessor_->count < 1) throw bad("it is empty");
        if (accessor_->count > (std::size_t(1) << 32)) throw bad("it has more than 2^32 elements");
        std::size_t const cost = accessor_->bufferView < 0 ? 4 : 1; // no buffer view: all zeros, no bytes
        d.spend(cost * accessor_->count, fmt::format("accessor {}", index));
    }
    tinygltf::Accessor const& accessor() const { return *accessor_; }
    ElementLayout const& layout() const { return layout_; }
    InputError bad(std::string const& why) const
    {
        return d_.error(fmt::format("accessor {} cannot be read", index_), why);
    }

    /// Calls put(element, component, pointer to its bytes), for the sparse values last.
    template <class Put>
    void walk(Put const& put) const
    {
        if (accessor_->bufferView >= 0) {
            auto const& view = d_.model.bufferViews;
            if (std::size_t(accessor_->bufferView) >= view.size()) throw bad("its buffer view does not exist");
            std::size_t const given = view[std::size_t(accessor_->bufferView)].byteStride;
            std::size_t const stride = given > 0 ? given : layout_.bytes();
            if (stride < layout_.bytes() || stride > 65536) throw bad("its stride is out of range");
            walk_elements(accessor_->bufferView, accessor_->byteOffset, accessor_->count, stride, put,
                          [](std::size_t i) { return i; });
        }
        if (accessor_->sparse.isSparse) walk_sparse(put);
    }

private:
    template <class Put, class Target>
    void walk_elements(int view, std::size_t offset, std::size_t count, std::size_t stride, Put const& put,
                       Target const& target) const
    {
        Bytes const bytes = d_.view_bytes(view);
        if (offset > bytes.size() || layout_.bytes() > bytes.size() - offset ||
            (count - 1) > (bytes.size() - offset - layout_.bytes()) / stride)
            throw bad(fmt::format("{} elements of {} bytes lie outside a buffer view of {}", count,
                                  layout_.bytes(), bytes.size()));
        std::size_t const rows = layout_.components / layout_.columns;
        for (std::size_t i = 0; i < count; ++i) {
            unsigned char const* const element = bytes.data() + offset + i * stride;
            for (std::size_t c = 0; c < layout_.components; ++c)
                put(target(i), c, element + c / rows * layout_.column_bytes + c % rows * layout_.component_bytes);
        }
    }
    template <class Put>
    void walk_sparse(Put const& put) const
    {
        auto const& s = accessor_->sparse;
        if (s.count < 1 || std::size_t(s.count) > accessor_->count) throw bad("its sparse count is out of range");
        if (std::cmp_less(s.indices.byteOffset, 0) || std::cmp_less(s.values.byteOffset, 0)) // or unsigned
            throw bad("a sparse offset is negative");
        std::int32_t const size = tinygltf::GetComponentSizeInBytes(std::uint32_t(s.indices.componentType));
        if (size != 1 && size != 2 && size != 4) throw bad("its sparse indices are not unsigned integers");
        auto const index_bytes = std::size_t(size), count = std::size_t(s.count);
        Bytes const all = d_.view_bytes(s.indices.bufferView);
        auto const offset = std::size_t(s.indices.byteOffset);
        if (offset > all.size() || count > (all.size() - offset) / index_bytes)
            throw bad("its sparse indices lie outside their buffer view");
        std::vector<std::uint32_t> where(count);
        for (std::size_t i = 0; i < count; ++i) {
            where[i] = to_integer(all.data() + offset + i * index_bytes, index_bytes);
            if (where[i] >= accessor_->count) throw bad("a sparse index is out of range");
        }
        walk_elements(s.values.bufferView, std::size_t(s.values.byteOffset), count, layout_.bytes(), put,
                      [&](std::size_t i) { return std::size_t(where[i]); });
    }

    GltfDocument& d_;
    int index_;
    tinygltf::Accessor const* accessor_ = nullptr;
    ElementLayout layout_{};
};

} // namespace

GltfArray read_floats(GltfDocument& document, int accessor, std::size_t components)
{
    AccessorReader const reader(document, accessor);
    GltfArray array;
    array.count = reader.accessor().count;
    array.components = reader.layout().components;
    if (components != 0 && array.components != components)
        throw reader.bad(fmt::format("it has {} components where {} are needed", array.components, components));
    array.values.assign(array.count * array.components, 0.0f);
    int const type = reader.accessor().componentType;
    bool const normalized = reader.accessor().normalized;
    reader.walk([&](std::size_t i, std::size_t c, unsigned char const* p) {
        array.values[i * array.components + c] = to_float(p, type, normalized);
    });
    return array;
}

std::vector<std::uint32_t> read_integers(GltfDocument& document, int accessor, std::size_t components)
{
    AccessorReader const reader(document, accessor);
    int const type = reader.accessor().componentType;
    if (reader.layout().components != components ||
        (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
         type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
        throw reader.bad(fmt::format("{} unsigned integers are needed", components));
    std::vector<std::uint32_t> values(reader.accessor().count * components, 0);
    reader.walk([&](std::size_t i, std::size_t c, unsigned char const* p) {
        values[i * components + c] = to_integer(p, reader.layout().component_bytes);
    });
    return values;
}

} // namespace gi
