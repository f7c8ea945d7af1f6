#include "ar/markers/aruco.h"

#include <algorithm>
#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

/// The number of a name is OpenCV's: both go in one order.
cv::Ptr<cv::aruco::Dictionary> dictionary_named(std::string const& name)
{
    auto const& names = dictionary_names();
    auto const at = std::find(names.begin(), names.end(), name);
    CV_Assert(at != names.end());
    return cv::aruco::getPredefinedDictionary(int(at - names.begin()));
}

double shortest_side(std::array<cv::Point2f, 4> const& c)
{
    double least = 1e9;
    for (std::size_t i = 0; i < 4; ++i) least = std::min(least, cv::norm(c[i] - c[(i + 1) % 4]));
    return least;
}

/// cv::cornerSubPix with a window that other edges of the marker do not reach: three tenths of a cell, at most 5
/// pixels, as OpenCV has it from 4.8 on.
void refine(cv::Mat const& gray, std::array<cv::Point2f, 4>& corners, int cells)
{
    int const window = std::clamp(int(std::lround(0.3 * shortest_side(corners) / cells)), 1, 5);
    std::vector<cv::Point2f> refined(corners.begin(), corners.end());
    cv::cornerSubPix(gray, refined, {window, window}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 0.005});
    for (std::size_t i = 0; i < 4; ++i)
        if (cv::norm(refined[i] - corners[i]) <= 2.0 * window) corners[i] = refined[i];
}

/// The board in OpenCV's frame: x right, y down from the upper left corner.
cv::Ptr<cv::aruco::CharucoBoard> board_of(CharucoBoard const& b)
{
    auto board = cv::aruco::CharucoBoard::create(b.squares_x, b.squares_y, float(b.square_m), float(b.marker_m),
                                                 dictionary_named(b.dictionary));
    for (int& id : board->ids) id += b.first_id;
    if (is_black(b, 0, 0)) return board;
    // 4.6 knows no legacy pattern: its markers and who stands beside which corner, as create() makes them.
    board->ids.clear();
    board->objPoints.clear();
    MarkerMap alone;
    alone.boards = {b};
    double const height = b.squares_y * b.square_m;
    for (PlacedMarker const& m : placed_markers(alone)) {
        board->ids.push_back(m.id);
        board->objPoints.emplace_back();
        for (auto const& c : m.corners_m)
            board->objPoints.back().emplace_back(float(c.x), float(height - c.y), 0.f);
    }
    for (std::size_t i = 0; i < board->chessboardCorners.size(); ++i) {
        board->nearestMarkerIdx[i].clear();
        board->nearestMarkerCorners[i].clear();
        cv::Point3f const at = board->chessboardCorners[i];
        for (std::size_t m = 0; m < board->objPoints.size(); ++m) {
            auto const& corners = board->objPoints[m];
            auto const nearest =
                std::min_element(corners.begin(), corners.end(), [&](auto const& p, auto const& q) {
                    return cv::norm(p - at) < cv::norm(q - at);
                });
            if (cv::norm(*nearest - at) > 0.75 * b.square_m) continue;
            board->nearestMarkerIdx[i].push_back(int(m));
            board->nearestMarkerCorners[i].push_back(int(nearest - corners.begin()));
        }
    }
    return board;
}

} // namespace

std::string name_of(Refinement refinement)
{
    constexpr std::array<char const*, 4> names{"none", "subpixel", "contour", "apriltag"};
    return names[std::size_t(refinement)];
}

FoundMarkers find_markers(cv::Mat const& gray, std::string const& dictionary, SearchSettings const& s)
{
    auto const codes = dictionary_named(dictionary);
    auto const p = cv::aruco::DetectorParameters::create();
    double const longest = std::max(gray.cols, gray.rows); // the rates are of this
    p->minMarkerPerimeterRate = 4 * s.smallest_side_px / longest;
    p->maxMarkerPerimeterRate = 4;
    p->adaptiveThreshWinSizeMin = s.smallest_window_px;
    p->adaptiveThreshWinSizeMax = s.largest_window_px;
    p->adaptiveThreshWinSizeStep = s.window_step_px;
    if (s.refinement == Refinement::contour) p->cornerRefinementMethod = cv::aruco::CORNER_REFINE_CONTOUR;
    if (s.refinement == Refinement::apriltag) p->cornerRefinementMethod = cv::aruco::CORNER_REFINE_APRILTAG;
    std::vector<std::vector<cv::Point2f>> corners, rejected;
    std::vector<int> ids;
    cv::aruco::detectMarkers(gray, codes, corners, ids, p, rejected);

    FoundMarkers found;
    found.rejected = int(rejected.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        FoundMarker m{ids[i], {corners[i][0], corners[i][1], corners[i][2], corners[i][3]}};
        if (s.refinement == Refinement::subpixel) refine(gray, m.corners, codes->markerSize + 2);
        found.markers.push_back(m);
    }
    return found;
}

std::vector<FoundCorner> find_inner_corners(cv::Mat const& gray, CharucoBoard const& board,
                                            std::vector<FoundMarker> const& markers)
{
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    for (FoundMarker const& m : markers) {
        corners.emplace_back(m.corners.begin(), m.corners.end());
        ids.push_back(m.id);
    }
    std::vector<FoundCorner> out;
    if (ids.empty()) return out;
    std::vector<cv::Point2f> pixels;
    std::vector<int> indices;
    cv::aruco::interpolateCornersCharuco(corners, ids, gray, board_of(board), pixels, indices);
    for (std::size_t i = 0; i < indices.size(); ++i) out.push_back({indices[i], pixels[i]});
    return out;
}

std::vector<std::vector<bool>> cells_of(std::string const& dictionary, int id)
{
    auto const codes = dictionary_named(dictionary);
    int const n = codes->markerSize + 2;
    cv::Mat picture;
    codes->drawMarker(id, n, picture, 1);
    std::vector<std::vector<bool>> cells(codes->markerSize + 2u, std::vector<bool>(codes->markerSize + 2u));
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) cells[std::size_t(y)][std::size_t(x)] = picture.at<std::uint8_t>(y, x) == 0;
    return cells;
}

} // namespace ar
