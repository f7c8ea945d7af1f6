#pragma once
// Corners within their pixels. OpenCV's own refinement takes L-shaped corners for symmetric ones, and knows
// nothing of black that grows or shrinks between paper and bytes; drawn pictures show it half a pixel off.

#include "ar/markers/aruco.h"

namespace ar {

/// In pixels.
double shortest_side(std::array<cv::Point2f, 4> const& corners);

/// Lines through the four sides of a marker, where bytes change most, and where they cross (as in AprilTag 3:
/// Krogius et al. 2019, section III), moved by how much black has grown, as the cells of the marker say. Where a
/// side has no edge, its corners stay.
/// @param cells as of cells_of
void refine_by_edges(cv::Mat const& gray, std::array<cv::Point2f, 4>& corners,
                     std::vector<std::vector<bool>> const& cells);

/// The inner corners of a board between two markers that were found: predicted by the homographies of both, found
/// by cv::cornerSubPix, and last the crossing of the two lines through the edges on its four sides.
std::vector<FoundCorner> find_inner_corners(cv::Mat const& gray, CharucoBoard const& board,
                                            std::vector<FoundMarker> const& markers);

} // namespace ar
