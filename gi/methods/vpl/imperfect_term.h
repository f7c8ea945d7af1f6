#pragma once
// Visibility by imperfect shadow maps, one for every virtual light of a pass.

#include "gi/methods/vpl/imperfect_map.h"
#include "gi/methods/vpl/visibility_term.h"

namespace gi {

class ImperfectTerm : public VisibilityTerm {
public:
    /// Throws InputError where a map is not 8 to 1024 texels wide, or no power of two.
    explicit ImperfectTerm(TermSource const& source);

    /// Draws the maps: each light has another subset of the points.
    void prepare(std::span<VirtualLight const> lights, std::uint32_t pass) override;
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
    std::vector<float> maps_; ///< of all lights, one after another
    std::vector<MappedLight> lights_;
    std::uint64_t drawn_ = 0; ///< maps, so far
};

} // namespace gi
