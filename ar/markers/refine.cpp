#include "ar/markers/refine.h"

#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace ar {
namespace {

/// Bilinear interpolation; clamped at the border.
float byte_at(cv::Mat const& gray, cv::Point2d p)
{
    double const x = std::clamp(p.x, 0., gray.cols - 1.), y = std::clamp(p.y, 0., gray.rows - 1.);
    int const x0 = int(x), y0 = int(y), x1 = std::min(x0 + 1, gray.cols - 1), y1 = std::min(y0 + 1, gray.rows - 1);
    auto const fx = float(x - x0), fy = float(y - y0);
    auto const *a = gray.ptr<std::uint8_t>(y0), *b = gray.ptr<std::uint8_t>(y1);
    return (1 - fy) * ((1 - fx) * a[x0] + fx * a[x1]) + fy * ((1 - fx) * b[x0] + fx * b[x1]);
}

struct Line {
    cv::Point2d on, normal;
};

struct EdgePoint {
    cv::Point2d at;
    double weight;
};

/// Locates the edge between `from` and `to`; the bright side is on the left of that direction, as seen with y
/// down: outside of a marker whose corners go clockwise. False if fewer than half of the samples have an edge.
bool add_edge(std::vector<EdgePoint>& points, cv::Mat const& gray, cv::Point2d from, cv::Point2d to,
              double reach_px)
{
    cv::Point2d const way = to - from;
    double const length = cv::norm(way);
    if (!(length > 1 && length < 1e5)) return false; // also where a homography ends at infinity
    cv::Point2d const out(way.y / length, -way.x / length);
    int const samples = std::clamp(int(length), 4, 80);
    int const steps = std::max(3, int(std::ceil(reach_px / 0.5)));
    std::vector<float> profile(std::size_t(2 * steps + 1));
    int found = 0;
    for (int i = 0; i < samples; ++i) {
        cv::Point2d const at = from + (i + 0.5) / samples * way;
        for (int k = -steps; k <= steps; ++k) profile[std::size_t(k + steps)] = byte_at(gray, at + 0.5 * k * out);
        double weight = 0, position = 0;
        for (int k = -steps + 1; k < steps; ++k) {
            double const slope = profile[std::size_t(k + 1 + steps)] - profile[std::size_t(k - 1 + steps)];
            if (slope <= 0) continue;
            weight += slope * slope;
            position += slope * slope * 0.5 * k;
        }
        if (weight < 100) continue; // no contrast
        points.push_back({at + position / weight * out, weight});
        ++found;
    }
    return 2 * found >= samples;
}

/// Least squares of distances.
Line line_through(std::vector<EdgePoint> const& points)
{
    double sum = 0, xx = 0, xy = 0, yy = 0;
    cv::Point2d mean(0, 0);
    for (auto const& p : points) {
        sum += p.weight;
        mean += p.weight * p.at;
    }
    mean *= 1 / sum;
    for (auto const& p : points) {
        cv::Point2d const d = p.at - mean;
        xx += p.weight * d.x * d.x;
        xy += p.weight * d.x * d.y;
        yy += p.weight * d.y * d.y;
    }
    double const angle = 0.5 * std::atan2(2 * xy, xx - yy);
    return {mean, {-std::sin(angle), std::cos(angle)}};
}

/// A side of a marker without its ends, where the adjacent side interferes.
std::optional<Line> side_between(cv::Mat const& gray, cv::Point2d from, cv::Point2d to, double reach_px)
{
    double const end = std::clamp(2.5 / cv::norm(to - from), 0.06, 0.25);
    std::vector<EdgePoint> points;
    if (!add_edge(points, gray, from + end * (to - from), to - end * (to - from), reach_px)) return std::nullopt;
    return line_through(points);
}

std::optional<cv::Point2d> crossing(Line const& a, Line const& b)
{
    double const det = a.normal.x * b.normal.y - a.normal.y * b.normal.x;
    if (std::abs(det) < 0.05) return std::nullopt;
    double const ca = a.normal.dot(a.on), cb = b.normal.dot(b.on);
    return cv::Point2d((ca * b.normal.y - cb * a.normal.y) / det, (a.normal.x * cb - b.normal.x * ca) / det);
}

cv::Point2d seen_at(cv::Mat const& homography, glm::dvec3 m)
{
    cv::Vec3d const p = cv::Matx33d(homography) * cv::Vec3d(m.x, m.y, 1);
    return {p[0] / p[2], p[1] / p[2]};
}

/// By how many pixels black has grown on each of its sides (less than 0: shrunk), by the tone curve, blooming or
/// sharpening. Between the black border and white cells beside it the edge is displaced the other way than
/// outside; the marker's own grid says where it would be.
double growth_of(cv::Mat const& gray, std::array<cv::Point2f, 4> const& corners,
                 std::vector<std::vector<bool>> const& cells)
{
    std::size_t const n = cells.size();
    auto const whole = float(n);
    std::array<cv::Point2f, 4> const grid{{{0, 0}, {whole, 0}, {whole, whole}, {0, whole}}};
    cv::Mat const homography = cv::getPerspectiveTransform(grid.data(), corners.data());
    double const reach_px = std::clamp(0.45 * shortest_side(corners) / double(n), 1., 3.);
    std::vector<double> growths;
    for (int side = 0; side < 4; ++side)
        for (std::size_t i = 1; i + 1 < n; ++i) {
            // The i-th cell along the side, clockwise, behind the border.
            std::array<std::size_t, 2> const row_column = side == 0   ? std::array{std::size_t(1), i}
                                                          : side == 1 ? std::array{i, n - 2}
                                                          : side == 2 ? std::array{n - 2, n - 1 - i}
                                                                      : std::array{n - 1 - i, std::size_t(1)};
            if (cells[row_column[0]][row_column[1]]) continue;
            auto const on_edge = [&](double along) { // clockwise from the side's first corner, one cell inside
                double const a = double(i) + along, b = double(n) - a, one = 1, last = double(n) - 1;
                return side == 0   ? seen_at(homography, {a, one, 0})
                       : side == 1 ? seen_at(homography, {last, a, 0})
                       : side == 2 ? seen_at(homography, {b, last, 0})
                                   : seen_at(homography, {one, b, 0});
            };
            cv::Point2d const from = on_edge(0.8), to = on_edge(0.2); // back: light is inside
            std::vector<EdgePoint> points;
            if (!add_edge(points, gray, from, to, reach_px)) continue;
            cv::Point2d const way = (to - from) / cv::norm(to - from), inward(way.y, -way.x);
            double sum = 0, weight = 0;
            for (auto const& p : points) {
                sum += p.weight * inward.dot(p.at - from);
                weight += p.weight;
            }
            growths.push_back(sum / weight / (2 * (1 - 1 / double(n))));
        }
    if (growths.size() < 4) return 0;
    return std::clamp(gi::median(std::move(growths)), -1., 1.);
}

/// Crossing of two lines of a chessboard. The four arms end at these points;
/// black is clockwise of the first and of the third.
std::optional<cv::Point2d> saddle(cv::Mat const& gray, cv::Point2d at, std::array<cv::Point2d, 4> const& ends,
                                  double reach_px)
{
    constexpr double kLongest_px = 30; // further away a lens bends lines
    std::array<std::vector<EdgePoint>, 2> lines;
    for (std::size_t i = 0; i < 4; ++i) {
        cv::Point2d const arm = ends[i] - at;
        double const length = cv::norm(arm), used = std::min(0.8 * length, kLongest_px);
        if (length < 6) return std::nullopt;
        cv::Point2d const near = at + 2 / length * arm, far = at + used / length * arm;
        bool const found = i % 2 == 0 ? add_edge(lines[0], gray, near, far, reach_px)
                                      : add_edge(lines[1], gray, far, near, reach_px);
        if (!found) return std::nullopt;
    }
    return crossing(line_through(lines[0]), line_through(lines[1]));
}

} // namespace

double shortest_side(std::array<cv::Point2f, 4> const& corners)
{
    double least = 1e9;
    for (std::size_t i = 0; i < 4; ++i) least = std::min(least, cv::norm(corners[i] - corners[(i + 1) % 4]));
    return least;
}

void refine_by_edges(cv::Mat const& gray, std::array<cv::Point2f, 4>& corners,
                     std::vector<std::vector<bool>> const& cells)
{
    double const cell = shortest_side(corners) / double(cells.size());
    auto now = corners;
    std::array<std::optional<Line>, 4> sides;
    auto const cross = [&] {
        for (std::size_t i = 0; i < 4; ++i) {
            auto const &before = sides[(i + 3) % 4], &after = sides[i];
            if (!before || !after) continue;
            auto const p = crossing(*before, *after);
            if (p && cv::norm(cv::Point2f(*p) - corners[i]) < 1 + cell) now[i] = *p;
        }
    };
    // First with a wide search, since contours are up to a pixel off, then only as far as a soft edge extends.
    for (double const reach_px : {std::clamp(0.8 * cell, 1.5, 4.), std::clamp(0.6 * cell, 1.5, 3.)}) {
        for (std::size_t i = 0; i < 4; ++i) sides[i] = side_between(gray, now[i], now[(i + 1) % 4], reach_px);
        cross();
    }
    double const growth_px = growth_of(gray, now, cells);
    cv::Point2d const middle = 0.25 * (now[0] + now[1] + now[2] + now[3]);
    for (auto& side : sides)
        if (side) side->on += (side->normal.dot(middle - side->on) > 0 ? growth_px : -growth_px) * side->normal;
    cross();
    corners = now;
}

std::vector<FoundCorner> find_inner_corners(cv::Mat const& gray, CharucoBoard const& board,
                                            std::vector<FoundMarker> const& markers)
{
    struct Prediction {
        std::vector<cv::Mat> homographies; ///< of the markers beside it
        double nearest_px = 1e9;           ///< corner of a marker
    };
    std::map<int, Prediction> predictions;
    MarkerMap alone;
    alone.boards = {board};
    auto const inner = inner_corners(board);
    std::map<int, FoundMarker const*> found;
    for (FoundMarker const& m : markers) found[m.id] = &m;
    for (PlacedMarker const& placed : placed_markers(alone)) {
        auto const at = found.find(placed.id);
        if (at == found.end()) continue;
        auto const& corners = at->second->corners;
        std::array<cv::Point2f, 4> plane;
        for (std::size_t i = 0; i < 4; ++i)
            plane[i] = {float(placed.corners_m[i].x), float(placed.corners_m[i].y)};
        cv::Mat const homography = cv::getPerspectiveTransform(plane.data(), corners.data());
        for (std::size_t i = 0; i < inner.size(); ++i)
            for (std::size_t c = 0; c < 4; ++c) {
                if (glm::distance(inner[i], placed.corners_m[c]) > 0.75 * (board.square_m - board.marker_m))
                    continue;
                Prediction& to = predictions[int(i)];
                to.homographies.push_back(homography);
                to.nearest_px =
                    std::min(to.nearest_px, cv::norm(seen_at(homography, inner[i]) - cv::Point2d(corners[c])));
            }
    }
    std::vector<FoundCorner> out;
    for (auto const& entry : predictions) {
        int const index = entry.first;
        Prediction const& p = entry.second;
        if (p.homographies.size() < 2) continue;
        auto const predicted = [&](glm::dvec3 m) {
            return 0.5 * (seen_at(p.homographies[0], m) + seen_at(p.homographies[1], m));
        };
        glm::dvec3 const corner_m = inner[std::size_t(index)];
        cv::Point2d const start = predicted(corner_m);
        // Windows that contain no part of a marker.
        int const window = std::clamp(int(p.nearest_px / std::sqrt(2.) - 0.5), 2, 8);
        double const border = window + 1;
        if (!(start.x >= border && start.y >= border && start.x <= gray.cols - 1 - border &&
              start.y <= gray.rows - 1 - border))
            continue;
        std::vector<cv::Point2f> pixel{start};
        cv::cornerSubPix(gray, pixel, {window, window}, {-1, -1},
                         {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 0.005});
        if (!(cv::norm(cv::Point2d(pixel[0]) - start) < window)) continue;
        // Arms to the right, down, left, up if the square on the lower right is black, else one further on.
        int const column = index % (board.squares_x - 1) + 1, row = index / (board.squares_x - 1) + 1;
        std::array<glm::dvec3, 4> const ways{{{1, 0, 0}, {0, -1, 0}, {-1, 0, 0}, {0, 1, 0}}};
        std::array<cv::Point2d, 4> ends;
        std::size_t const first = is_black(board, column, row) ? 0 : 1;
        for (std::size_t i = 0; i < 4; ++i) ends[i] = predicted(corner_m + board.square_m * ways[(first + i) % 4]);
        auto const exact = saddle(gray, pixel[0], ends, std::clamp(0.7 * p.nearest_px, 1.5, 3.));
        if (exact && cv::norm(*exact - cv::Point2d(pixel[0])) < 1) pixel[0] = *exact;
        out.push_back({index, pixel[0]});
    }
    return out;
}

} // namespace ar
