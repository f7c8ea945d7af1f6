#pragma once
// Visibility by imperfect shadow maps, one per virtual light of a pass.

#include "gi/methods/vpl/imperfect_map.h"
#include "gi/methods/vpl/settings.h"
#include "gi/methods/vpl/visibility_term.h"

namespace gi {

class ImperfectTerm : public VisibilityTerm {
public:
    /// Throws InputError if the map's width is not a power of two from 8 to 1024 texels.
    explicit ImperfectTerm(TermSource const& source);

    /// Draws the maps: each light uses a different subset of the points.
    void prepare(std::span<LightVertex const> lights, std::uint32_t pass, PassStop const& stop) override;
    void world_changed() override;
    void of_connections(ReceiverTile const& tile, std::span<Connection const> connections, std::span<float> shares,
                        PathCounts& counts) const override;
    void report_work(Report& report) override;

private:
    World const& world_;
    VirtualLightSettings vpl_;
    std::uint64_t seed_;
    PointCloud cloud_;
    HemisphereGrid grid_;
    std::vector<float> maps_; ///< of all lights, consecutively
    std::vector<MappedLight> lights_;
    std::uint64_t drawn_ = 0; ///< number of maps drawn so far
};

} // namespace gi
