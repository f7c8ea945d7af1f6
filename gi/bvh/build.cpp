#include "gi/bvh/build_kernels.h"
#include "gi/kernel/launch.h"
#include "gi/kernel/scan.h"
#include "gi/kernel/sort.h"

#include <algorithm>

namespace gi {
namespace {

template <class T, Space S>
T last_of(Buffer<T, S> const& buffer, std::size_t n)
{
    T value;
    copy_bytes(Space::host, &value, S, buffer.view().data + n - 1, sizeof(T));
    return value;
}

template <class T>
View<T> first_of(View<T> view, std::size_t n)
{
    return {view.data, n};
}

/// Sums of counts before each item, in place. Returns the sum of all.
template <Space S>
std::uint32_t scan(Buffer<std::uint32_t, S>& counts, std::size_t n)
{
    std::uint32_t const last = last_of(counts, n);
    View<std::uint32_t> const all = first_of(counts.view(), n);
    exclusive_scan(S, {all.data, n}, all);
    return last_of(counts, n) + last;
}

/// One buffer of all parts, in their order.
template <class T, Space S>
Buffer<T, S> concatenate(std::vector<Buffer<T, S>> const& parts)
{
    std::size_t n = 0;
    for (Buffer<T, S> const& part : parts) n += part.size();
    Buffer<T, S> all(n);
    n = 0;
    for (Buffer<T, S> const& part : parts) {
        copy_bytes(S, all.view().data + n, S, part.view().data, part.size() * sizeof(T));
        n += part.size();
    }
    return all;
}

template <Space S>
class Builder {
public:
    Builder(TriangleList const& list, StopRequest const* stop)
        : list_(list), count_(list.last - list.first), stop_(stop)
    {
    }
    /// @param in_pairs  a balanced tree: neighbours along the curve join, whatever their boxes
    Bvh<S> build(bool in_pairs)
    {
        order_triangles();
        cluster(in_pairs);
        cut();
        return write();
    }

private:
    void check_stop() const
    {
        if (stop_.given_up()) throw Interrupted();
    }
    void order_triangles();
    void cluster(bool in_pairs);
    void cut();
    Bvh<S> write();

    TriangleList list_;
    std::uint32_t count_;
    BuildStop stop_;
    Buffer<Box, S> boxes_, node_boxes_; ///< of triangles, and of binary nodes
    Buffer<std::uint32_t, S> order_;
    Buffer<BinaryNode, S> inner_;
    Buffer<Cuts, S> cuts_;
    std::vector<std::uint32_t> steps_; ///< first binary node of each step of clustering, then their number
};

template <Space S>
void Builder<S>::order_triangles()
{
    std::size_t const chunks = (count_ + FindBoxes::kChunk - 1) / FindBoxes::kChunk;
    boxes_ = Buffer<Box, S>(count_);
    Buffer<Box, S> chunk_boxes(chunks);
    launch(S, "boxes of triangles", chunks, FindBoxes{list_, boxes_.view(), chunk_boxes.view()});
    Box all;
    for (Box const& box : download(chunk_boxes)) all = joined(all, box);
    float const extent = all.empty() ? 0.0f : max_component(all.high - all.low);
    float const per_m = extent > 0 ? 2097151.0f / extent : 0.0f;
    order_ = Buffer<std::uint32_t, S>(count_);
    Buffer<std::uint64_t, S> keys(count_), scratch_keys(count_);
    Buffer<std::uint32_t, S> scratch(count_);
    launch(S, "places along the Morton curve", count_,
           FindKeys{std::as_const(boxes_).view(), all.low, per_m, keys.view(), order_.view()});
    sort_pairs(S, keys.view(), order_.view(), scratch_keys.view(), scratch.view());
    check_stop();
}

template <Space S>
void Builder<S>::cluster(bool in_pairs)
{
    inner_ = Buffer<BinaryNode, S>(count_ - 1);
    node_boxes_ = Buffer<Box, S>(2 * std::size_t(count_) - 1);
    Buffer<Box, S> boxes(count_), next_boxes(count_);
    Buffer<std::uint32_t, S> nodes(count_), next_nodes(count_), nearest(count_), joins(count_), stays(count_);
    launch(S, "first clusters", count_,
           StartClusters{std::as_const(boxes_).view(), std::as_const(order_).view(), boxes.view(),
                         node_boxes_.view(), nodes.view()});
    std::size_t n = count_;
    std::uint32_t made = count_;
    bool slow = in_pairs;
    while (n > 1) {
        steps_.push_back(made);
        View<Box const> const now = first_of(std::as_const(boxes).view(), n);
        View<std::uint32_t const> const chosen{nearest.view().data, n};
        launch(S, "nearest clusters", n, FindNeighbours{now, slow, nearest.view()});
        launch(S, "marks of clusters", n, MarkPairs{chosen, joins.view(), stays.view()});
        std::uint32_t const joined = scan(joins, n), left = scan(stays, n);
        launch(S, "join clusters", n,
               JoinPairs{chosen, std::as_const(nodes).view(), now, std::as_const(joins).view(),
                         std::as_const(stays).view(), count_, made, next_boxes.view(), node_boxes_.view(),
                         next_nodes.view(), inner_.view()});
        // A tree of steps that join few would take too long, and be too deep.
        slow = in_pairs || joined < n / 20;
        made += joined;
        n = left;
        std::swap(boxes, next_boxes);
        std::swap(nodes, next_nodes);
        check_stop();
    }
    steps_.push_back(made);
}

template <Space S>
void Builder<S>::cut()
{
    cuts_ = Buffer<Cuts, S>(inner_.size());
    for (std::size_t k = 0; k + 1 < steps_.size(); ++k)
        launch(S, "cuts into wide nodes", steps_[k + 1] - steps_[k],
               FindCuts{std::as_const(inner_).view(), std::as_const(node_boxes_).view(), count_, steps_[k],
                        cuts_.view()});
    check_stop();
}

template <Space S>
Bvh<S> Builder<S>::write()
{
    std::vector<Buffer<WideNode, S>> nodes;
    std::vector<Buffer<Leaf, S>> leaves;
    Bvh<S> out;
    Buffer<std::uint32_t, S> roots = upload<S>(std::vector<std::uint32_t>{2 * count_ - 2});
    std::uint32_t all_nodes = 0, all_leaves = 0;
    while (roots.size() > 0) {
        std::size_t const n = roots.size();
        out.level.push_back(all_nodes);
        all_nodes += std::uint32_t(n);
        Buffer<Children, S> children(n);
        Buffer<std::uint32_t, S> inner_children(n), leaf_children(n);
        launch(S, "children of wide nodes", n,
               ChooseChildren{std::as_const(inner_).view(), std::as_const(cuts_).view(), count_,
                              std::as_const(roots).view(), children.view(), inner_children.view(),
                              leaf_children.view()});
        std::uint32_t const below = scan(inner_children, n), here = scan(leaf_children, n);
        nodes.emplace_back(n);
        leaves.emplace_back(here);
        Buffer<std::uint32_t, S> next(below);
        launch(S, "wide nodes", n,
               WriteNodes{std::as_const(inner_).view(), count_, list_.first, std::as_const(order_).view(),
                          std::as_const(children).view(), std::as_const(inner_children).view(),
                          std::as_const(leaf_children).view(), all_nodes, all_leaves, nodes.back().view(),
                          leaves.back().view(), next.view()});
        all_leaves += here;
        roots = std::move(next);
    }
    out.level.push_back(all_nodes);
    out.nodes = concatenate(nodes);
    out.leaves = concatenate(leaves);
    out.boxes = Buffer<Box, S>(all_nodes);
    refit(out, list_);
    return out;
}

} // namespace

template <Space S>
void refit(Bvh<S>& bvh, TriangleList const& list)
{
    launch(S, "refit leaves", bvh.leaves.size(), RefitLeaves{list, bvh.leaves.view()});
    for (std::size_t k = bvh.level.size(); k-- > 1;)
        launch(S, "refit nodes", bvh.level[k] - bvh.level[k - 1],
               RefitNodes{list, bvh.nodes.view(), std::as_const(bvh.leaves).view(), bvh.boxes.view(),
                          bvh.level[k - 1]});
}

template <Space S>
Bvh<S> build_bvh(TriangleList const& list, StopRequest const* stop)
{
    if (list.first >= list.last) return {};
    Bvh<S> bvh = Builder<S>(list, stop).build(false);
    if (bvh.level.size() > kDeepest) bvh = Builder<S>(list, stop).build(true);
    return bvh;
}

template Bvh<Space::host> build_bvh(TriangleList const&, StopRequest const*);
template void refit(Bvh<Space::host>&, TriangleList const&);
template Bvh<Space::device> build_bvh(TriangleList const&, StopRequest const*);
template void refit(Bvh<Space::device>&, TriangleList const&);

} // namespace gi
