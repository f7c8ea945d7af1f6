#pragma once
// Human-readable summary of a scene.

#include "gi/scene/model/world.h"

#include <string>
#include <vector>

namespace gi {

struct SummaryLine {
    std::string what;  ///< "triangles", "cameras", ...
    std::string value; ///< "52140", "gallery, arches, courtyard"
};

struct SceneSummary {
    std::vector<SummaryLine> lines;
};

SceneSummary summarise(World const& world);

} // namespace gi
