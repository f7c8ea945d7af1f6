#pragma once
// Visibility by layered hit buffers (gi/methods/slhb):
// a connection is tested by a walk along the stored axis nearest to its direction (Yu 2012, sec. 5.3.1);
// it is blocked if the walk hits a surface before it passes the far end.
//
// The walk starts at the receiver if the axis leaves it on the lit side, else at the virtual light if the axis
// leaves that. If the axis leaves neither end (both nearly edge-on), the connection is treated as unblocked and
// counted. With o the angle between direction and axis, the walk passes the far end at a distance of |x - y| sin
// o; a hit there may be on the far end's own surface. So hits do not block within texel + (texel + that distance)
// * slope of the far surface against the axis, up to half the length of the connection.

#include "gi/hit_buffers/directions/stored_axes.h"
#include "gi/methods/vpl/visibility_term.h"

#include <atomic>

namespace gi {

class LayerTerm : public VisibilityTerm {
public:
    /// Builds the hit buffers: SlhbSettings::directions, resolution, most_layers.
    /// Throws InputError on unknown directions.
    explicit LayerTerm(TermSource const& source);

    void prepare(std::span<LightVertex const> lights, std::uint32_t, PassStop const&) override
    {
        lights_ = lights;
    }
    void world_changed() override { axes_.moved(); }
    void of_connections(ReceiverTile const& tile, std::span<Connection const> connections, std::span<float> shares,
                        PathCounts& counts) const override;
    void report_work(Report& report) override;

private:
    struct End;
    struct Walks;
    bool leave(End const& from, End const& to, std::uint32_t direction, std::uint32_t connection,
               Walks& walks) const;

    World const& world_;
    StoredAxes axes_;
    std::span<LightVertex const> lights_;
    mutable std::atomic<std::uint64_t> unanswered_ = 0, queries_ = 0;
    std::uint64_t lost_ = 0; ///< layers already reported as lost
};

} // namespace gi
