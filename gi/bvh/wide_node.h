#pragma once
// Nodes and leaves of the bounding volume hierarchy (BVH), in one form for CPU and CUDA.
//
// A node has up to eight children, whose boxes are bytes relative to the node's own box (after Ylitie, Karras and
// Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs"); 80 bytes. Boxes are
// rounded outwards, so that a child's box contains its triangles. The inner children of a node lie one after the
// other in the array of nodes, and its leaves in the array of leaves.

#include "gi/core/math.h"

#include <bit>

namespace gi {

inline constexpr int kBvhWidth = 8, kLeafTriangles = 4;
inline constexpr std::uint32_t kNoLeafTriangle = 0xffffffffu;

struct alignas(16) WideNode {
    float corner[3];          ///< below the low corner of the node's box, m
    std::uint8_t exponent[3]; ///< per axis: one step of the bytes below is 2^(exponent - 127) m
    std::uint8_t children;    ///< their number; first the leaves, then the nodes
    std::uint32_t first_node; ///< index of the first inner child
    std::uint32_t first_leaf;
    std::uint32_t leaves; ///< number of leaf children
    std::uint32_t unused;
    std::uint8_t low[3][kBvhWidth], high[3][kBvhWidth]; ///< per axis and child

    GI_FN float step(int axis) const { return std::bit_cast<float>(std::uint32_t(exponent[axis]) << 23); }
    GI_FN bool is_leaf(std::uint32_t k) const { return k < leaves; }
    /// Index of child k among the leaves or the nodes.
    GI_FN std::uint32_t child(std::uint32_t k) const
    {
        return is_leaf(k) ? first_leaf + k : first_node + k - leaves;
    }
};
static_assert(sizeof(WideNode) == 80);

/// Corners of up to four triangles, coordinate by coordinate for vectors of four.
struct alignas(16) Leaf {
    float corner[9][kLeafTriangles];        ///< [3 * corner + axis], m
    std::uint32_t triangle[kLeafTriangles]; ///< index in the world; kNoLeafTriangle = none, its corners are 0
};

/// Axis-aligned box that kernels can read and write. Empty: low > high.
struct Box {
    vec3 low{kInf}, high{-kInf};

    GI_FN bool empty() const { return !(low.x <= high.x); }
    /// Half of the surface area, m^2; 0 if empty.
    GI_FN float half_area() const
    {
        vec3 const e = glm::max(high - low, vec3{0});
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
};
GI_FN inline Box joined(Box const& a, Box const& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }

/// Part of a step by which children's boxes are larger than their triangles: exceeds what traversal's sums of
/// bytes and corner, which cancel near the ray's origin, lose by rounding (about 2^-14 steps).
inline constexpr float kBoxMargin = 0x1p-10f;

/// The smallest power of two that is not below x, as a float's exponent. @param x  not negative
GI_FN inline std::uint8_t exponent_above(float x)
{
    std::uint32_t const bits = std::bit_cast<std::uint32_t>(x);
    std::uint32_t const exponent = (bits >> 23) + ((bits & 0x7fffffu) != 0 ? 1 : 0);
    return std::uint8_t(exponent < 1 ? 1 : exponent > 254 ? 254 : exponent);
}

/// Sets the frame of a node's bytes: corner and steps, with room for margins. @param box  not empty
GI_FN inline void set_frame(WideNode& node, Box const& box)
{
    for (int axis = 0; axis < 3; ++axis) {
        float const low = box.low[axis], high = box.high[axis];
        node.exponent[axis] = exponent_above((high - low) * (1.0f / 250));
        // Below the box, also where a step is less than the rounding of coordinates.
        float const below = low - node.step(axis), less = low - 0x1p-23f * std::abs(low);
        node.corner[axis] = below < less ? below : less;
        node.exponent[axis] = exponent_above((high - node.corner[axis]) * (1.0f / 250));
    }
}

/// Sets child k's box, rounded outwards; an empty one can never be hit.
GI_FN inline void set_child_box(WideNode& node, int k, Box const& box)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (box.empty()) {
            node.low[axis][k] = 255;
            node.high[axis][k] = 0;
            continue;
        }
        float const step = node.step(axis), corner = node.corner[axis];
        // Differences of neighbouring floats are exact, others round by less than the margin.
        float const low = (box.low[axis] - corner) / step - kBoxMargin,
                    high = (box.high[axis] - corner) / step + kBoxMargin;
        node.low[axis][k] = std::uint8_t(glm::clamp(std::floor(low), 0.0f, 255.0f));
        node.high[axis][k] = std::uint8_t(glm::clamp(std::ceil(high), 0.0f, 255.0f));
    }
}

} // namespace gi
