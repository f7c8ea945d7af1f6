#pragma once
#include "gi/scene/motion/moving_world.h"

#include <algorithm>

namespace viewer {

/// Reports a loss for triangles that lose their area or become non-finite while moving. Counts only those beyond
/// the largest number seen so far.
class FlatTriangles {
public:
    /// @param first  changes up to the first frame; its triangles were counted when the world was built
    explicit FlatTriangles(gi::Changes const& first) : most_(first.flat_triangles) {}

    void see(gi::Changes const& now, gi::Report& report)
    {
        if (now.flat_triangles > most_)
            report.lose("triangles that moved so that they have no area, or are not finite",
                        now.flat_triangles - most_);
        most_ = std::max(most_, now.flat_triangles);
    }

private:
    std::uint64_t most_;
};

} // namespace viewer
