#pragma once
// Wraps OpenCV's aruco module in plain values. Only aruco.cpp uses its classes: up to 4.6 they are in
// opencv_contrib, from 4.7 on in objdetect under other names.

#include "ar/markers/marker_map.h"

#include <opencv2/core.hpp>

namespace ar {

/// Method of subpixel corner refinement.
enum class Refinement {
    none,     ///< corners of the contour
    edges,    ///< lines through the sides (refine.h)
    subpixel, ///< gradients around a corner (Foerstner)
    contour,  ///< lines through the contour
    apriltag, ///< AprilTag 2's own search for quads (Wang and Olson 2016); slow
};

struct SearchSettings {
    Refinement refinement = Refinement::edges;
    double smallest_side_px = 12; ///< minimum side of markers
    int enlarge = 1; ///< factor by which the picture is enlarged first; 2 for markers with few pixels per cell
    /// Windows of the adaptive threshold, pixels of the enlarged picture, odd.
    int smallest_window_px = 3, largest_window_px = 23, window_step_px = 10;
};

/// A marker in a picture; pixel centres have integer coordinates.
struct FoundMarker {
    int id = 0;
    /// Upper left, upper right, lower right, lower left as printed (AprilTags:
    /// as in the pictures of their makers).
    std::array<cv::Point2f, 4> corners;
};

struct FoundMarkers {
    std::vector<FoundMarker> markers; ///< an identifier may occur more than once
    int rejected = 0;                 ///< squares without a known code
};

/// @param gray CV_8UC1; @param dictionary an existing name
FoundMarkers find_markers(cv::Mat const& gray, std::string const& dictionary, SearchSettings const& settings);

struct FoundCorner {
    int index = 0; ///< of inner_corners()
    cv::Point2f pixel;
};
/// The cells of a marker, border included, row by row from the top left; true = black.
std::vector<std::vector<bool>> cells_of(std::string const& dictionary, int id);

} // namespace ar
