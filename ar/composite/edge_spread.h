#pragma once
// How sharp a camera's pictures are, from straight edges whose place is known: the sides of markers. Across an
// edge,
//   value(d) = dark + (bright - dark) Phi((d - offset - tilt t) / sigma),   Phi: the normal distribution's
//   integral
// d: distance to the line in pixels, t: place along it. Slanted-edge method (ISO 12233) with a Gaussian spread.

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
    double sigma_px = 0;  ///< of lens, motion and the pixel's own square together
    double offset_px = 0; ///< of the edge from the segment
    double contrast = 0;  ///< bright - dark
    double residual = 0;  ///< rms, of the contrast
};

struct SpreadSettings {
    double reach_px = 6;          ///< to either side; half of the edge's length at most
    double ends = 0.15;           ///< of the length, left out at either end: corners
    double least_contrast = 0.02; ///< of the picture's units
    double largest_residual = 0.1;
};

/// One edge; nothing where there is no edge of that contrast, too few pixels, or another shape.
/// @param light  CV_32FC1, linear (a channel of radiance_of, or its luminance)
std::optional<EdgeSpread> fit_edge(cv::Mat const& light, EdgeSegment const& edge,
                                   SpreadSettings const& settings = {});

struct Sharpness {
    double sigma_px = 0;  ///< median of the edges
    double spread_px = 0; ///< 1.4826 MAD: lens blur varies over the picture, motion blur with the direction
    int edges = 0;        ///< that count
    int refused = 0;
};

/// Nothing without an edge that counts. @throws gi::InputError another type
std::optional<Sharpness> estimate_sharpness(cv::Mat const& light, std::span<EdgeSegment const> edges,
                                            SpreadSettings const& settings = {});

} // namespace ar
