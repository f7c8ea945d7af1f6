#pragma once
// Subpixel corner refinement. OpenCV's own refinement treats L-shaped corners as symmetric, and ignores that black
// regions may grow or shrink between paper and bytes; on synthetic pictures it is half a pixel off.

#include "ar/markers/aruco.h"

namespace ar {

/// Shortest side of a marker, pixels.
double shortest_side(std::array<cv::Point2f, 4> const& corners);

/// Fits lines to the four sides of a marker, where the gradient is largest, and intersects them (as in AprilTag 3:
/// Krogius et al. 2019, section III), corrected for the growth of black regions estimated from the marker's cells.
/// Corners of a side without an edge stay unchanged.
/// @param cells from cells_of
void refine_by_edges(cv::Mat const& gray, std::array<cv::Point2f, 4>& corners,
                     std::vector<std::vector<bool>> const& cells);

/// Finds the inner corners of a board between two detected markers: predicted by the homographies of both, located
/// by cv::cornerSubPix, and finally the intersection of the two lines through the edges on its four sides.
std::vector<FoundCorner> find_inner_corners(cv::Mat const& gray, CharucoBoard const& board,
                                            std::vector<FoundMarker> const& markers);

} // namespace ar
