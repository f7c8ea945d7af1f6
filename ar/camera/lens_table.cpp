#include "ar/camera/lens_table.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {

LensTable::LensTable(cv::Mat plane) : plane_(std::move(plane))
{
    CV_Assert(plane_.type() == CV_64FC2 && plane_.cols >= 2 && plane_.rows >= 2);
    auto const bad = [](int x, int y, std::string const& why) {
        return gi::InputError(fmt::format("the lens table at pixel ({}, {})", x, y), why,
                              "write the map again, for the whole picture");
    };
    auto const at = [&](int x, int y) {
        cv::Vec2d const v = plane_.at<cv::Vec2d>(y, x);
        return glm::dvec2(v[0], v[1]);
    };
    for (int y = 0; y < plane_.rows; ++y)
        for (int x = 0; x < plane_.cols; ++x)
            if (!std::isfinite(at(x, y).x) || !std::isfinite(at(x, y).y)) throw bad(x, y, "it is not finite");
    for (int y = 0; y + 1 < plane_.rows; ++y)
        for (int x = 0; x + 1 < plane_.cols; ++x) {
            glm::dvec2 const right = at(x + 1, y) - at(x, y), down = at(x, y + 1) - at(x, y);
            if (!(right.x * down.y - right.y * down.x > 0))
                throw bad(x, y, "it folds: the next pixels do not see what lies to the right and below");
        }
}

LensTable::Cell LensTable::cell_at(glm::dvec2 pixel) const
{
    int const x = std::clamp(int(std::floor(pixel.x)), 0, plane_.cols - 2),
              y = std::clamp(int(std::floor(pixel.y)), 0, plane_.rows - 2);
    auto const at = [&](int i, int j) {
        cv::Vec2d const v = plane_.at<cv::Vec2d>(y + j, x + i);
        return glm::dvec2(v[0], v[1]);
    };
    double const u = pixel.x - x, v = pixel.y - y;
    glm::dvec2 const top = at(1, 0) - at(0, 0), bottom = at(1, 1) - at(0, 1), left = at(0, 1) - at(0, 0),
                     right = at(1, 1) - at(1, 0);
    return {at(0, 0) + u * top + v * (left + u * (right - left)), glm::mix(top, bottom, v),
            glm::mix(left, right, u)};
}

std::optional<glm::dvec2> LensTable::plane_at(glm::dvec2 pixel) const
{
    glm::dvec2 const low = -margin(), high = glm::dvec2(size_px()) - 1.0 + margin();
    if (!(pixel.x >= low.x && pixel.y >= low.y && pixel.x <= high.x && pixel.y <= high.y)) return std::nullopt;
    return cell_at(pixel).value;
}

std::optional<glm::dvec2> LensTable::pixel_of(glm::dvec2 plane, glm::dvec2 guess) const
{
    glm::dvec2 const low = -margin(), high = glm::dvec2(size_px()) - 1.0 + margin();
    glm::dvec2 p = glm::clamp(guess, low, high);
    for (int i = 0; i < 40; ++i) {
        Cell const c = cell_at(p);
        glm::dvec2 const miss = c.value - plane;
        double const det = c.by_x.x * c.by_y.y - c.by_x.y * c.by_y.x;
        if (!(std::abs(det) > 0)) return std::nullopt;
        glm::dvec2 const step(
            glm::dvec2(c.by_y.y * miss.x - c.by_y.x * miss.y, c.by_x.x * miss.y - c.by_x.y * miss.x) / det);
        glm::dvec2 const next = p - step;
        if (std::max(std::abs(step.x), std::abs(step.y)) < 1e-9) {
            bool const inside = next.x >= low.x && next.y >= low.y && next.x <= high.x && next.y <= high.y;
            return inside ? std::optional(next) : std::nullopt;
        }
        p = glm::clamp(next, low - 1.0, high + 1.0);
    }
    return std::nullopt;
}

} // namespace ar
