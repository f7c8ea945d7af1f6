#pragma once
// Bounding volume hierarchy over triangles, built and refitted by kernels on CPU or CUDA.

#include "gi/bvh/wide_node.h"
#include "gi/core/progress.h"
#include "gi/kernel/buffer.h"

#include <vector>

namespace gi {

struct BvhView {
    View<WideNode const> nodes; ///< the root first, children after their parents; empty = no triangles
    View<Leaf const> leaves;
};

/// A tree in memory space S.
template <Space S>
struct Bvh {
    Buffer<WideNode, S> nodes;
    Buffer<Leaf, S> leaves;
    Buffer<Box, S> boxes;             ///< of the nodes, as refitting needs them
    std::vector<std::uint32_t> level; ///< first node of each depth, then the number of nodes

    BvhView view() const { return {nodes.view(), leaves.view()}; }
    std::size_t bytes() const
    {
        return nodes.size() * (sizeof(WideNode) + sizeof(Box)) + leaves.size() * sizeof(Leaf);
    }
};
using HostBvh = Bvh<Space::host>;

/// Depth of the deepest tree for which traversal has a stack; deeper ones are built again as balanced trees.
inline constexpr std::size_t kDeepest = 40;

/// Triangles by their corners. The views lie in the memory space of the tree.
struct TriangleList {
    View<vec3 const> positions;
    View<uvec3 const> triangles;
    std::uint32_t first = 0, last = 0; ///< those of the tree
};

/// Builds a tree, by locally ordered clustering of the triangles along a Morton curve (Meister and Bittner 2018)
/// and the best cuts of that binary tree into wide nodes (Ylitie et al. 2017, sec. 3.1). The same bits for any
/// number of threads. Triangles with corners that are not finite or beyond kFarthest stay in the tree without a
/// box, so that refit may bring them back.
/// @param stop  checked between steps; throws Interrupted. Null = never
template <Space S>
Bvh<S> build_bvh(TriangleList const& list, StopRequest const* stop = nullptr);

/// Updates boxes and corners of triangles that moved. Triangles must have kept their indices.
template <Space S>
void refit(Bvh<S>& bvh, TriangleList const& list);

} // namespace gi
