#pragma once
#include "gi/scene/motion/moving_world.h"

#include <algorithm>

namespace viewer {

/// Reports triangles that collapse or turn not finite while they move: whenever there are more than ever before.
class FlatTriangles {
public:
    /// @param first  to the first moment, whose own are counted as the world is built
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
