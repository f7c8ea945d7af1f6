#pragma once
// What the HTML pages of calibrations have in common.

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace ar {

/// Up to and with the heading. @param title plain text
std::string page_begin(std::string const& title);
std::string page_end();

/// A curve among points: an SVG with both axes from 0 and their largest values.
/// @param curve in rising x @param across, up what the axes are, plain text
std::string plot(std::vector<cv::Point2d> const& points, std::vector<cv::Point2d> const& curve,
                 std::string const& across, std::string const& up);

} // namespace ar
