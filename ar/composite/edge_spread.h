#pragma once
// Measures the sharpness of a camera's pictures at straight edges of known position: the sides of markers.
// Across an edge,
//   value(d) = dark + (bright - dark) Phi((d - offset - tilt t) / sigma)
// Phi: the normal distribution's integral, d: distance to the line in pixels, t: place along it.
// Slanted-edge method (ISO 12233) with a Gaussian spread.

#include <glm/glm.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

namespace ar {

struct EdgeSegment {
    glm::dvec2 from, to; ///< pixels; centres of pixels are whole numbers
};

struct EdgeSpread {
    double sigma_px = 0;  ///< of lens, motion and pixel area together
    double offset_px = 0; ///< distance of the edge from the segment
    double contrast = 0;  ///< bright - dark
    double residual = 0;  ///< RMS, relative to the contrast
};

struct SpreadSettings {
    double reach_px = 6;          ///< distance evaluated on either side; at most half the edge's length
    double ends = 0.15;           ///< share of the length left out at either end, to avoid corners
    double least_contrast = 0.02; ///< in units of the picture
    double largest_residual = 0.1;
};

/// Fits one edge; nothing if the contrast is too low, there are too few pixels, or the profile does not fit.
/// @param light  CV_32FC1, linear (a channel of radiance_of, or its luminance)
std::optional<EdgeSpread> fit_edge(cv::Mat const& light, EdgeSegment const& edge,
                                   SpreadSettings const& settings = {});

struct Sharpness {
    double sigma_px = 0;  ///< median of the edges
    double spread_px = 0; ///< 1.4826 MAD: lens blur varies over the picture, motion blur with the direction
    int edges = 0;        ///< number used
    int refused = 0;
};

/// Median sharpness of the edges; nothing if no edge is usable. @throws gi::InputError wrong type
std::optional<Sharpness> estimate_sharpness(cv::Mat const& light, std::span<EdgeSegment const> edges,
                                            SpreadSettings const& settings = {});

} // namespace ar
