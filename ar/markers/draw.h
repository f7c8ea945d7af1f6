#pragma once
// Draws markers, boards and grids for printing at the right size: as pictures and as SVG in millimetres. A white
// margin surrounds the black, since a marker is recognised by its edge. The paper's lower left corner is at
// -margin in both axes of the drawn object.

#include "ar/markers/marker_map.h"

#include <filesystem>
#include <opencv2/core.hpp>

namespace ar {

/// A black rectangle, in metres from the lower left corner of the paper.
struct PrintedRectangle {
    double left_m, bottom_m, width_m, height_m;
};
struct Sheet {
    double width_m = 0, height_m = 0;
    glm::dvec2 origin_m{0}; ///< position of the origin of the drawn object's frame
    std::vector<PrintedRectangle> black;
};

/// @param thing number within the map; @param margin_m width of the white margin; -1: one cell of a marker
Sheet sheet_of(MarkerMap const& map, int thing, double margin_m = -1);

/// Renders to CV_8UC1, 0 and 255; dots on an edge are grey by coverage, so that edges are exact.
/// The paper's upper left corner is the upper left corner of the first dot.
/// @throws gi::InputError more than 20,000 dots per side
cv::Mat draw(Sheet const& sheet, double dots_per_m);
/// SVG with width and height in mm, so that it prints at true size.
std::string to_svg(Sheet const& sheet);

/// Writes a PNG with its resolution in dots per metre (pHYs). @throws gi::InputError
void write_png(std::filesystem::path const& file, cv::Mat const& drawing, double dots_per_m);

} // namespace ar
