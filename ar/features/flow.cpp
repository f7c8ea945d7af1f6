#include "ar/features/flow.h"

#include <opencv2/video/tracking.hpp>

namespace ar {
namespace {

constexpr int kLevels = 3;
cv::Size const kWindow(21, 21);
constexpr double kBack_px = 0.5;

std::vector<cv::Point2f> points_of(std::vector<glm::dvec2> const& from)
{
    std::vector<cv::Point2f> to;
    for (glm::dvec2 const& p : from) to.emplace_back(float(p.x), float(p.y));
    return to;
}

} // namespace

std::vector<std::optional<glm::dvec2>> Flow::next(cv::Mat const& gray, std::vector<glm::dvec2> const& points,
                                                  std::vector<glm::dvec2> const& guesses)
{
    std::vector<std::optional<glm::dvec2>> found(points.size());
    std::vector<cv::Mat> now;
    cv::buildOpticalFlowPyramid(gray, now, kWindow, kLevels);
    if (!points.empty() && size_ == gray.size()) {
        std::vector<cv::Point2f> const from = points_of(points);
        std::vector<cv::Point2f> to = guesses.size() == points.size() ? points_of(guesses) : from, back = from;
        std::vector<unsigned char> there, again;
        cv::Mat error;
        cv::TermCriteria const end(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
        cv::calcOpticalFlowPyrLK(before_, now, from, to, there, error, kWindow, kLevels, end,
                                 cv::OPTFLOW_USE_INITIAL_FLOW);
        cv::calcOpticalFlowPyrLK(now, before_, to, back, again, error, kWindow, kLevels, end,
                                 cv::OPTFLOW_USE_INITIAL_FLOW);
        for (std::size_t k = 0; k < points.size(); ++k) {
            bool const inside =
                to[k].x > 2 && to[k].y > 2 && to[k].x < float(gray.cols - 3) && to[k].y < float(gray.rows - 3);
            if (there[k] && again[k] && inside && cv::norm(back[k] - from[k]) < kBack_px)
                found[k] = glm::dvec2(to[k].x, to[k].y);
        }
    }
    before_ = std::move(now);
    size_ = gray.size();
    return found;
}

} // namespace ar
