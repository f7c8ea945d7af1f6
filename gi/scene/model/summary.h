#pragma once
// What is in a scene, for people.

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
