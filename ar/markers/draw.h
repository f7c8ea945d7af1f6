#pragma once
// Markers, boards and grids to be printed at the right size: as pictures and as SVG in millimetres. Around the
// black there is white: a marker is recognised by its edge. The paper's lower left corner is at
// -margin in both axes of what is drawn.

#include "ar/markers/marker_map.h"

#include <filesystem>
#include <opencv2/core.hpp>

namespace ar {

/// What is printed, in metres from the lower left corner of the paper.
struct PrintedRectangle {
    double left_m, bottom_m, width_m, height_m; ///< black
};
struct Sheet {
    double width_m = 0, height_m = 0;
    glm::dvec2 origin_m{0}; ///< where the origin of the thing's frame is
    std::vector<PrintedRectangle> black;
};

/// @param thing number within the map; @param margin_m of white around what is black; -1: one cell of a marker
Sheet sheet_of(MarkerMap const& map, int thing, double margin_m = -1);

/// CV_8UC1, 0 and 255; where an edge passes through a dot, what is covered (so that edges are where they belong).
/// The paper's upper left corner is the upper left edge of the first dot.
/// @throws gi::InputError more than 20,000 dots a side
cv::Mat draw(Sheet const& sheet, double dots_per_m);
/// Width and height in mm, so that it prints at its size.
std::string to_svg(Sheet const& sheet);

/// PNG with its dots per metre (pHYs). @throws gi::InputError
void write_png(std::filesystem::path const& file, cv::Mat const& drawing, double dots_per_m);

} // namespace ar
