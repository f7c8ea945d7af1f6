#pragma once
// A room with a table on which a printed board lies: the place of synthetic sessions, where everything is known.
// World: metres, y up; the top of the table is y = 0; the camera is on the side of +z.

#include "gi/scene/model/scene.h"

#include <opencv2/core.hpp>

namespace viewer {

/// A sheet of paper lying on the table, its upper edge away from the camera.
struct PaperOnTable {
    cv::Mat print; ///< CV_8UC1, upper row first
    double width_m = 0, depth_m = 0;
    glm::dvec2 near_left_m{0}; ///< x and z of its lower left corner
};

/// What of the room is modelled beside the virtual things: the compositor never knows more of it than `near`.
enum class DeskPart {
    whole, ///< walls, window, lamp, table, things on it, paper
    near,  ///< what stands on the table and the table: where shadows and light of virtual things fall
};

gi::Scene generate_desk(DeskPart part, PaperOnTable const& paper);

/// A figure of 0.36 m that walks in its place, and a red ball: feet and ball at y = 0.
gi::Scene generate_statue();

} // namespace viewer
