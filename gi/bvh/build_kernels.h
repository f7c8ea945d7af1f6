#pragma once
// Steps of building a BVH, as kernels for CPU and CUDA. See bvh.h for the method and build.cpp for their order.
//
// The binary tree: nodes 0 to n - 1 are the triangles along a Morton curve, later ones inner nodes; children have
// lower numbers than their parents, and the root is the last.

#include "gi/bvh/bvh.h"
#include "gi/core/morton.h"

namespace gi {

struct BinaryNode {
    std::uint32_t left, right; ///< of inner nodes
    std::uint32_t triangles;   ///< number below
};

/// Cheapest cuts of a binary node's subtree into wide nodes: cost[k] with at most k + 1 roots, m^2.
struct Cuts {
    static constexpr int kMost = kBvhWidth - 1;

    float cost[kMost];
    /// split[0]: 0 = the subtree is one leaf, else its node gives that many of its 8 children to the left.
    /// split[k]: 0 = fewer roots are as good, else that many of the k + 1 roots go to the left.
    std::uint8_t split[kMost + 1];
};

/// Costs of a step of traversal, in units of a node.
inline constexpr float kNodeCost = 1, kLeafCost = 0.6f;

GI_FN inline Box triangle_box(TriangleList const& list, std::uint32_t triangle)
{
    uvec3 const v = list.triangles[triangle];
    vec3 const a = list.positions[v.x], b = list.positions[v.y], c = list.positions[v.z];
    Box const box = joined(joined({a, a}, {b, b}), {c, c});
    bool const usable = all_finite(a) && all_finite(b) && all_finite(c) &&
                        glm::max(max_component(box.high), max_component(-box.low)) < kFarthest;
    return usable ? box : Box{};
}

/// Boxes of triangles, and of each chunk of kChunk triangles.
struct FindBoxes {
    static constexpr std::size_t kChunk = 1024;
    TriangleList list;
    View<Box> boxes, chunks;

    GI_FN void operator()(std::size_t chunk) const
    {
        std::size_t const n = boxes.size(), first = chunk * kChunk, last = first + kChunk < n ? first + kChunk : n;
        Box all;
        for (std::size_t i = first; i < last; ++i) {
            boxes[i] = triangle_box(list, list.first + std::uint32_t(i));
            all = joined(all, boxes[i]);
        }
        chunks[chunk] = all;
    }
};

/// Place along a Morton curve of 2^21 steps per axis; triangles without a box come last.
struct FindKeys {
    View<Box const> boxes;
    vec3 low;
    float per_m; ///< steps
    View<std::uint64_t> keys;
    View<std::uint32_t> order;

    GI_FN void operator()(std::size_t i) const
    {
        order[i] = std::uint32_t(i);
        Box const& box = boxes[i];
        if (box.empty()) {
            keys[i] = ~std::uint64_t(0);
            return;
        }
        vec3 const at = glm::clamp((0.5f * (box.low + box.high) - low) * per_m, 0.0f, 2097151.0f);
        keys[i] = morton(std::uint32_t(at.x), std::uint32_t(at.y), std::uint32_t(at.z));
    }
};

/// The first clusters: the triangles in order.
struct StartClusters {
    View<Box const> triangle_boxes;
    View<std::uint32_t const> order;
    View<Box> boxes, node_boxes;
    View<std::uint32_t> nodes;

    GI_FN void operator()(std::size_t i) const
    {
        boxes[i] = node_boxes[i] = triangle_boxes[order[i]];
        nodes[i] = std::uint32_t(i);
    }
};

/// For each cluster, that neighbour along the curve with which the common box is smallest.
struct FindNeighbours {
    static constexpr std::size_t kReach = 5;
    View<Box const> boxes;
    bool in_pairs; ///< pairs of neighbours instead
    View<std::uint32_t> nearest;

    GI_FN void operator()(std::size_t i) const
    {
        std::size_t const n = boxes.size(), first = i > kReach ? i - kReach : 0,
                          last = i + kReach < n ? i + kReach + 1 : n;
        if (in_pairs) {
            nearest[i] = std::uint32_t((i ^ 1) < n ? i ^ 1 : i);
            return;
        }
        Box const own = boxes[i];
        float best = kInf;
        std::size_t at = i, tie = ~std::size_t(0);
        for (std::size_t j = first; j < last; ++j) {
            if (j == i) continue;
            float const area = joined(own, boxes[j]).half_area();
            // Ties in an order that is the same from both sides, and pairs many clusters at once.
            if (area < best || (area == best && (i ^ j) < tie)) {
                best = area;
                at = j;
                tie = i ^ j;
            }
        }
        nearest[i] = std::uint32_t(at);
    }
};

/// Marks the clusters that join (those that chose each other) and those that stay.
struct MarkPairs {
    View<std::uint32_t const> nearest;
    View<std::uint32_t> joins, stays; ///< 1 or 0

    GI_FN void operator()(std::size_t i) const
    {
        std::uint32_t const j = nearest[i];
        bool const mutual = j != i && nearest[j] == i;
        joins[i] = mutual && i < j ? 1 : 0;
        stays[i] = mutual && i > j ? 0 : 1;
    }
};

struct JoinPairs {
    View<std::uint32_t const> nearest, nodes;
    View<Box const> boxes;
    View<std::uint32_t const> joined_before, stayed_before; ///< sums of MarkPairs' marks
    std::uint32_t triangles, first_node;                    ///< of all; the next inner node
    View<Box> next_boxes, node_boxes;
    View<std::uint32_t> next_nodes;
    View<BinaryNode> inner; ///< by node - triangles

    GI_FN std::uint32_t below(std::uint32_t node) const
    {
        return node < triangles ? 1 : inner[node - triangles].triangles;
    }
    GI_FN void operator()(std::size_t i) const
    {
        std::uint32_t const j = nearest[i];
        bool const mutual = j != i && nearest[j] == i;
        if (mutual && i > j) return;
        std::uint32_t const to = stayed_before[i];
        if (!mutual) {
            next_boxes[to] = boxes[i];
            next_nodes[to] = nodes[i];
            return;
        }
        std::uint32_t const node = first_node + joined_before[i];
        Box const box = joined(boxes[i], boxes[j]);
        inner[node - triangles] = {nodes[i], nodes[j], below(nodes[i]) + below(nodes[j])};
        next_boxes[to] = node_boxes[node] = box;
        next_nodes[to] = node;
    }
};

/// Finds the best cuts of the inner nodes from `first` on; those of their children are known.
struct FindCuts {
    View<BinaryNode const> inner;
    View<Box const> node_boxes;
    std::uint32_t triangles, first;
    View<Cuts> cuts; ///< by inner node

    /// Cost of a child's subtree with at most `roots` roots.
    GI_FN float cost(std::uint32_t node, int roots) const
    {
        return node < triangles ? kLeafCost * node_boxes[node].half_area()
                                : cuts[node - triangles].cost[roots - 1];
    }
    GI_FN void operator()(std::size_t i) const
    {
        std::uint32_t const at = first + std::uint32_t(i) - triangles;
        BinaryNode const& node = inner[at];
        Cuts c;
        auto const best_split = [&](int roots, std::uint8_t& split) {
            float best = kInf;
            for (int left = 1; left < roots; ++left) {
                if (left > Cuts::kMost || roots - left > Cuts::kMost) continue;
                float const both = cost(node.left, left) + cost(node.right, roots - left);
                if (both < best || left == 1) {
                    best = both;
                    split = std::uint8_t(left);
                }
            }
            return best;
        };
        float const area = node_boxes[at + triangles].half_area();
        std::uint8_t split = 1;
        float const as_node = kNodeCost * area + best_split(kBvhWidth, split);
        bool const leaf = node.triangles <= kLeafTriangles && !(as_node < kLeafCost * area);
        c.cost[0] = leaf ? kLeafCost * area : as_node;
        c.split[0] = leaf ? 0 : split;
        for (int roots = 2; roots <= Cuts::kMost; ++roots) {
            float const apart = best_split(roots, split);
            bool const better = apart < c.cost[roots - 2];
            c.cost[roots - 1] = better ? apart : c.cost[roots - 2];
            c.split[roots - 1] = better ? split : 0;
        }
        c.split[Cuts::kMost] = 0;
        cuts[at] = c;
    }
};

/// Children of a wide node: binary nodes; the leaves among them come first.
struct Children {
    std::uint32_t node[kBvhWidth];
    std::uint32_t leaves = 0, all = 0;
};

/// Chooses the children of the wide nodes of one depth.
struct ChooseChildren {
    View<BinaryNode const> inner;
    View<Cuts const> cuts;
    std::uint32_t triangles;
    View<std::uint32_t const> roots; ///< binary node of each wide node
    View<Children> children;
    View<std::uint32_t> nodes, leaves; ///< numbers of children

    GI_FN bool is_leaf(std::uint32_t node) const
    {
        return node < triangles || cuts[node - triangles].split[0] == 0;
    }
    GI_FN void operator()(std::size_t i) const
    {
        struct Part {
            std::uint32_t node;
            int roots;
        };
        Part stack[2 * kBvhWidth];
        int top = 0;
        Children c;
        std::uint32_t found[kBvhWidth], n = 0;
        if (std::uint32_t const root = roots[i]; is_leaf(root)) { // of the whole tree
            found[n++] = root;
        } else {
            int const left = cuts[root - triangles].split[0];
            stack[top++] = {inner[root - triangles].right, kBvhWidth - left};
            stack[top++] = {inner[root - triangles].left, left};
        }
        while (top > 0) {
            auto [node, number] = stack[--top];
            if (node >= triangles)
                while (number > 1 && cuts[node - triangles].split[number - 1] == 0) --number;
            if (node < triangles || number == 1) {
                found[n++] = node;
                continue;
            }
            int const left = cuts[node - triangles].split[number - 1];
            stack[top++] = {inner[node - triangles].right, number - left};
            stack[top++] = {inner[node - triangles].left, left};
        }
        for (std::uint32_t k = 0; k < n; ++k)
            if (is_leaf(found[k])) c.node[c.all++] = found[k];
        c.leaves = c.all;
        for (std::uint32_t k = 0; k < n; ++k)
            if (!is_leaf(found[k])) c.node[c.all++] = found[k];
        children[i] = c;
        nodes[i] = c.all - c.leaves;
        leaves[i] = c.leaves;
    }
};

/// Writes the wide nodes of one depth and the triangles of their leaves, without boxes.
struct WriteNodes {
    View<BinaryNode const> inner;
    std::uint32_t triangles, first_triangle;
    View<std::uint32_t const> order;
    View<Children const> children;
    View<std::uint32_t const> nodes_before, leaves_before;
    std::uint32_t first_node, first_leaf; ///< of the next depth; of this depth's leaves
    View<WideNode> out;
    View<Leaf> leaves; ///< of this depth
    View<std::uint32_t> next_roots;

    GI_FN void write_leaf(std::uint32_t root, Leaf& leaf) const
    {
        std::uint32_t stack[kLeafTriangles];
        int top = 0, n = 0;
        for (int k = 0; k < kLeafTriangles; ++k) leaf.triangle[k] = kNoLeafTriangle;
        stack[top++] = root;
        while (top > 0) {
            std::uint32_t const node = stack[--top];
            if (node < triangles) {
                leaf.triangle[n++] = first_triangle + order[node];
            } else {
                stack[top++] = inner[node - triangles].right;
                stack[top++] = inner[node - triangles].left;
            }
        }
    }
    GI_FN void operator()(std::size_t i) const
    {
        Children const& c = children[i];
        WideNode node{};
        node.first_leaf = first_leaf + leaves_before[i];
        node.first_node = first_node + nodes_before[i];
        node.leaves = c.leaves;
        node.children = std::uint8_t(c.all);
        for (std::uint32_t k = 0; k < c.leaves; ++k) write_leaf(c.node[k], leaves[leaves_before[i] + k]);
        for (std::uint32_t k = c.leaves; k < c.all; ++k) next_roots[nodes_before[i] + k - c.leaves] = c.node[k];
        out[i] = node;
    }
};

/// Corners of the leaves' triangles; of those without a box, none.
struct RefitLeaves {
    TriangleList list;
    View<Leaf> leaves;

    GI_FN void operator()(std::size_t i) const
    {
        Leaf& leaf = leaves[i];
        for (int k = 0; k < kLeafTriangles; ++k) {
            std::uint32_t const t = leaf.triangle[k];
            bool const usable = t != kNoLeafTriangle && !triangle_box(list, t).empty();
            for (int corner = 0; corner < 3; ++corner) {
                vec3 const p = usable ? list.positions[list.triangles[t][corner]] : vec3{0};
                for (int axis = 0; axis < 3; ++axis) leaf.corner[3 * corner + axis][k] = p[axis];
            }
        }
    }
};

/// Boxes of the nodes of one depth, from those of their children.
struct RefitNodes {
    TriangleList list;
    View<WideNode> nodes;
    View<Leaf const> leaves;
    View<Box> boxes; ///< of all nodes
    std::uint32_t first;

    GI_FN Box box_of(Leaf const& leaf) const
    {
        Box box;
        for (std::uint32_t const t : leaf.triangle)
            if (t != kNoLeafTriangle) box = joined(box, triangle_box(list, t));
        return box;
    }
    GI_FN Box child_box(WideNode const& node, std::uint32_t k) const
    {
        std::uint32_t const at = node.child(k);
        return node.is_leaf(k) ? box_of(leaves[at]) : boxes[at];
    }
    GI_FN void operator()(std::size_t i) const
    {
        WideNode& node = nodes[first + i];
        Box all;
        for (std::uint32_t k = 0; k < node.children; ++k) all = joined(all, child_box(node, k));
        boxes[first + i] = all;
        set_frame(node, all.empty() ? Box{vec3{0}, vec3{0}} : all);
        // Found again, not kept in an array: nvcc 13.0 takes what one was initialised with for what it holds.
        for (int k = 0; k < kBvhWidth; ++k)
            set_child_box(node, k, k < node.children ? child_box(node, std::uint32_t(k)) : Box{});
    }
};

} // namespace gi
