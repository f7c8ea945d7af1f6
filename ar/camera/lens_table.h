#pragma once
// A lens as a table: where the centre of each pixel of the distorted picture lies on the plane z = 1. Between
// centres it is bilinear; beyond the picture, by 2 % of its size (4 pixels at least), it continues linearly.

#include <glm/glm.hpp>
#include <opencv2/core.hpp>
#include <optional>

namespace ar {

class LensTable {
public:
    /// @param plane  CV_64FC2: x / z and y / z of the ray of each pixel, 2 x 2 pixels or more
    /// @throws gi::InputError values that are not finite, a table that folds (neighbouring pixels change sides)
    explicit LensTable(cv::Mat plane);

    glm::ivec2 size_px() const { return {plane_.cols, plane_.rows}; }
    /// Nothing farther than 2 % of the picture (4 pixels at least) outside of it.
    std::optional<glm::dvec2> plane_at(glm::dvec2 pixel) const;
    /// Inverts plane_at by Newton's method, to 1e-9 of a pixel. @param guess  a pixel
    std::optional<glm::dvec2> pixel_of(glm::dvec2 plane, glm::dvec2 guess) const;

private:
    struct Cell {
        glm::dvec2 value, by_x, by_y;
    };
    Cell cell_at(glm::dvec2 pixel) const;
    glm::dvec2 margin() const { return glm::max(glm::dvec2(4), 0.02 * glm::dvec2(size_px())); }

    cv::Mat plane_;
};

} // namespace ar
