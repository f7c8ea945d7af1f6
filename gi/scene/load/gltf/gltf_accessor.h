#pragma once
// Reads typed arrays from a glTF file: strides, normalised integers, sparse accessors.

#include "gi/core/math.h"
#include "gi/scene/load/gltf/gltf_document.h"

namespace gi {

/// `count` items of `components` numbers each.
struct GltfArray {
    std::size_t count = 0, components = 0;
    std::vector<float> values;

    vec2 as_vec2(std::size_t i) const { return {values[2 * i], values[2 * i + 1]}; }
    vec3 as_vec3(std::size_t i) const
    {
        float const* const p = values.data() + components * i;
        return {p[0], p[1], p[2]};
    }
    vec4 as_vec4(std::size_t i) const
    {
        float const* const p = values.data() + components * i;
        return {p[0], p[1], p[2], p[3]};
    }
};

/// Reads floats; integers of a normalized accessor become -1..1 or 0..1.
/// Throws InputError if anything is out of range.
/// @param components required number of components; 0 = any
GltfArray read_floats(GltfDocument& document, int accessor, std::size_t components);
/// Reads unsigned integers, one component for indices, four for joints.
std::vector<std::uint32_t> read_integers(GltfDocument& document, int accessor, std::size_t components);

} // namespace gi
