#pragma once
// Follows points from one picture to the next: pyramidal Lucas-Kanade (Bouguet 2001), there and back.

#include <glm/glm.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace ar {

class Flow {
public:
    /// The points of the previous picture in this one; nothing for points that are lost: outside, without texture,
    /// or not back within half a pixel. All are lost in the first picture and after a change of size.
    /// @param gray  CV_8UC1  @param guesses  of their new positions, or empty
    std::vector<std::optional<glm::dvec2>> next(cv::Mat const& gray, std::vector<glm::dvec2> const& points,
                                                std::vector<glm::dvec2> const& guesses = {});

private:
    std::vector<cv::Mat> before_; ///< pyramid
    cv::Size size_;
};

} // namespace ar
