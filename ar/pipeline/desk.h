#pragma once
// The scene of synthetic sessions, in which everything is known: a room with a printed board on a table.
// World: metres, y up; the top of the table is y = 0; the camera is on the side of +z.

#include "gi/scene/model/scene.h"

#include <opencv2/core.hpp>

namespace ar {

/// A sheet of paper lying on the table, its upper edge away from the camera.
struct PaperOnTable {
    cv::Mat print; ///< CV_8UC1, upper row first; empty = no paper
    double width_m = 0, depth_m = 0;
    glm::dvec2 near_left_m{0}; ///< x and z of its lower left corner
};

/// Part of the room that is modelled; the compositor only ever gets `near`.
enum class DeskPart {
    whole, ///< walls, window, lamp, table, things on it, paper
    near,  ///< the table and the objects on it, which receive shadows and light of virtual objects
};

/// What lies on the table.
enum class TableCloth {
    none,
    printed ///< a cloth with a random pattern of squares of many sizes, for tracking without markers
};

gi::Scene generate_desk(DeskPart part, PaperOnTable const& paper, TableCloth cloth = TableCloth::none);

/// A figure 0.36 m tall that walks in place, and a red ball; both stand on y = 0.
gi::Scene generate_statue();

} // namespace ar
