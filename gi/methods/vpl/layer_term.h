#pragma once
// Visibility by layered hit buffers (gi/methods/slhb): a connection is walked along the stored axis nearest to its
// direction (Yu 2012, sec. 5.3.1), and is blocked if the walk meets a surface before it comes past its far end.
//
// The walk starts at the receiver if its axis leaves that on the lit side, else at the virtual light, if the axis
// leaves that one; connections that no axis leaves at either end (nearly edge-on at both) count as free, and are
// counted. With o the angle between direction and axis, the walk passes the far end at a distance of
// |x - y| sin o; what it meets there may be the far end's own surface, so hits within a texel and that distance
// times the far surface's slope against the axis do not block, up to half the way.

#include "gi/methods/slhb/directions/axis_set.h"
#include "gi/methods/slhb/directions/direction_map.h"
#include "gi/methods/vpl/visibility_term.h"
#include "gi/raster/triangle_soup.h"

#include <atomic>

namespace gi {

class LayerTerm : public VisibilityTerm {
public:
    /// Builds the hit buffers: SlhbSettings::directions, resolution, most_layers. Throws InputError on directions
    /// that there are not.
    explicit LayerTerm(TermSource const& source);

    void prepare(std::span<VirtualLight const> lights, std::uint32_t) override { lights_ = lights; }
    void world_changed() override;
    void of_connections(ReceiverTile const& tile, std::span<Connection const> connections, std::span<float> shares,
                        PathCounts& counts) const override;
    void report_work(Report& report) override;

private:
    /// A direction of the set: 2 k along axis k, 2 k + 1 against it.
    struct Direction {
        vec3 along;  ///< unit
        float texel; ///< m, of its buffer
    };
    struct End;
    struct Walks;
    void build(Bounds const& bounds);
    bool leave(End const& from, End const& to, std::uint32_t direction, std::uint32_t connection,
               Walks& walks) const;

    World const& world_;
    SlhbSettings slhb_;
    std::uint64_t seed_;
    std::size_t first_moving_;
    TriangleSoup soup_;
    CutOuts cut_outs_;
    Bounds bounds_; ///< of the grids
    std::unique_ptr<AxisSet> axes_;
    std::vector<Direction> directions_;
    DirectionMap nearest_;
    std::span<VirtualLight const> lights_;
    mutable std::atomic<std::uint64_t> unanswered_ = 0, queries_ = 0;
    std::uint64_t lost_ = 0; ///< layers that were reported
};

} // namespace gi
