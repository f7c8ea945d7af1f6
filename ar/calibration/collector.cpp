#include "ar/calibration/collector.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

constexpr double kStill_px = 1.5; ///< largest motion between frames; more causes blur
constexpr double kAlike = 0.12;   ///< distance of features
constexpr double kTilted = 0.2;   ///< 17 degrees, as a feature
constexpr int kColumns = 8, kRows = 6;

/// Mean motion of the points in both views; nothing if they share none.
std::optional<double> moved_px(BoardView const& a, BoardView const& b)
{
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < a.board_m.size(); ++i)
        for (std::size_t j = 0; j < b.board_m.size(); ++j)
            if (glm::distance(a.board_m[i], b.board_m[j]) < 1e-9) {
                sum += glm::distance(a.pixels[i], b.pixels[j]);
                ++count;
            }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

void count_cells(cv::Mat& cells, BoardView const& view, glm::ivec2 size_px)
{
    cv::Mat seen = cv::Mat::zeros(kRows, kColumns, CV_8U);
    for (auto const& p : view.pixels)
        seen.at<std::uint8_t>(std::clamp(int((p.y + 0.5) / size_px.y * kRows), 0, kRows - 1),
                              std::clamp(int((p.x + 0.5) / size_px.x * kColumns), 0, kColumns - 1)) = 1;
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x) cells.at<int>(y, x) += seen.at<std::uint8_t>(y, x);
}

} // namespace

Collector::Collector(glm::ivec2 size_px, ViewSource source, LensModel lens, int wanted)
    : size_px_(size_px), source_(source), lens_(lens), wanted_(wanted)
{
    if (size_px.x < 1 || size_px.y < 1)
        throw gi::InputError(fmt::format("pictures of {} x {} pixels", size_px.x, size_px.y),
                             "there is nothing in them", "give the camera's size");
}

Collector::Features Collector::features_of(BoardView const& view) const
{
    CameraModel camera{LensModel::pinhole, size_px_, 0.9 * size_px_.x, 0.9 * size_px_.x, 0.5 * size_px_.x,
                       0.5 * size_px_.y,   {}};
    if (live_) camera = live_->camera;
    glm::dvec2 low(1e30), high(-1e30), middle(0);
    for (auto const& p : view.pixels) {
        low = glm::min(low, p);
        high = glm::max(high, p);
        middle += p / double(view.pixels.size());
    }
    Features f{middle.x / size_px_.x, middle.y / size_px_.y,
               std::sqrt(std::max(0., (high.x - low.x) * (high.y - low.y)) / (double(size_px_.x) * size_px_.y)), 0,
               0};
    if (auto const pose = camera_from_board(camera, view)) {
        glm::dvec3 const out = pose->rotation * glm::dvec3(0, 0, 1);
        f[3] = 0.7 * out.x;
        f[4] = 0.7 * out.y;
    }
    return f;
}

Offer Collector::offer(BoardView view)
{
    Offer offer;
    if (view.pixels.size() < kFewestPoints) {
        ++counts_.too_few_points;
        last_.reset();
        offer.why =
            fmt::format("{} points of the board are seen, {} are needed", view.pixels.size(), kFewestPoints);
        return offer;
    }
    if (live_)
        if (auto const pose = camera_from_board(live_->camera, view))
            offer.rms_px = rms(residuals(live_->camera, *pose, view));
    auto const way = source_ == ViewSource::live && last_ ? moved_px(*last_, view) : std::nullopt;
    bool const moving = source_ == ViewSource::live && (!way || *way > kStill_px);
    last_ = view;
    if (moving) {
        ++counts_.moving;
        offer.why = "hold the board still";
        return offer;
    }
    Features const f = features_of(view);
    double nearest = 1e30;
    for (Features const& other : features_) {
        double sum = 0;
        for (std::size_t k = 0; k < f.size(); ++k) sum += (f[k] - other[k]) * (f[k] - other[k]);
        nearest = std::min(nearest, std::sqrt(sum));
    }
    cv::Mat const before = coverage();
    cv::Mat after = before.clone();
    count_cells(after, view, size_px_);
    int const new_cells = cv::countNonZero(after) - cv::countNonZero(before);
    if (nearest < kAlike && new_cells < 2) {
        ++counts_.alike;
        offer.why = "this is like a view that is there: " + next();
        return offer;
    }
    offer.taken = true;
    ++counts_.taken;
    features_.push_back(f);
    views_.push_back(std::move(view));
    if (views_.size() >= 4 && tilted()) {
        try {
            live_ = calibrate_lens(views_, size_px_, lens_);
        } catch (gi::InputError const&) {
            live_.reset(); // the next view may help
        }
    }
    return offer;
}

bool Collector::tilted() const
{
    for (std::size_t k : {3u, 4u}) {
        auto const [least, most] = std::minmax_element(features_.begin(), features_.end(),
                                                       [k](auto const& a, auto const& b) { return a[k] < b[k]; });
        if (least != features_.end() && (*most)[k] - (*least)[k] >= kTilted) return true;
    }
    return false;
}

cv::Mat Collector::coverage() const
{
    cv::Mat cells = cv::Mat::zeros(kRows, kColumns, CV_32S);
    for (BoardView const& v : views_) count_cells(cells, v, size_px_);
    return cells;
}

std::string Collector::next() const
{
    // Ninths of the picture, from the emptiest.
    cv::Mat const cells = coverage();
    int least = 1 << 30, at = 0;
    for (int ninth = 0; ninth < 9; ++ninth) {
        int covered = 0, all = 0;
        for (int y = 0; y < kRows; ++y)
            for (int x = 0; x < kColumns; ++x)
                if (x * 3 / kColumns == ninth % 3 && y * 3 / kRows == ninth / 3) {
                    covered += cells.at<int>(y, x) > 0;
                    ++all;
                }
        int const share = 100 * covered / all;
        if (share < least) {
            least = share;
            at = ninth;
        }
    }
    static char const* const places[] = {"upper left", "top",        "upper right", "left",       "middle",
                                         "right",      "lower left", "bottom",      "lower right"};
    if (least < 50) return fmt::format("show the board in the {} of the picture", places[at]);
    double left = 0, right = 0, up = 0, down = 0, small = 1, large = 0;
    for (Features const& f : features_) {
        left = std::min(left, f[3]);
        right = std::max(right, f[3]);
        up = std::min(up, f[4]);
        down = std::max(down, f[4]);
        small = std::min(small, f[2]);
        large = std::max(large, f[2]);
    }
    if (left > -kTilted) return "turn the board so that it faces left in the picture, by about 30 degrees";
    if (right < kTilted) return "turn the board so that it faces right in the picture, by about 30 degrees";
    if (up > -kTilted) return "tilt the board so that it faces up, by about 30 degrees";
    if (down < kTilted) return "tilt the board so that it faces down, by about 30 degrees";
    if (large < 1.3 * small) return "show the board from nearer or further away";
    if (int(views_.size()) < wanted_) return "show the board anywhere else";
    return {};
}

} // namespace ar
