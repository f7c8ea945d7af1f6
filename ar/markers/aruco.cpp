#include "ar/markers/aruco.h"

#include "ar/markers/apriltag.h"
#include "ar/markers/refine.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/version.hpp>
#include <opencv2/imgproc.hpp>
#define LIGHTWELL_OPENCV (100 * CV_VERSION_MAJOR + CV_VERSION_MINOR)
#if LIGHTWELL_OPENCV >= 407
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

namespace ar {
namespace {

/// Names in OpenCV's order, so that the index is OpenCV's number.
cv::aruco::Dictionary dictionary_named(std::string const& name)
{
    auto const& names = dictionary_names();
    auto const at = std::find(names.begin(), names.end(), name);
    CV_Assert(at != names.end());
    int const number = int(at - names.begin());
#if LIGHTWELL_OPENCV >= 407
    return cv::aruco::getPredefinedDictionary(number);
#else
    return *cv::aruco::getPredefinedDictionary(number);
#endif
}

using Corners = std::vector<std::vector<cv::Point2f>>;

void detect(cv::Mat const& searched, cv::aruco::Dictionary const& dictionary,
            cv::aruco::DetectorParameters const& parameters, Corners& corners, std::vector<int>& ids,
            Corners& rejected)
{
#if LIGHTWELL_OPENCV >= 407
    cv::aruco::ArucoDetector(dictionary, parameters).detectMarkers(searched, corners, ids, rejected);
#else
    cv::aruco::detectMarkers(searched, cv::makePtr<cv::aruco::Dictionary>(dictionary), corners, ids,
                             cv::makePtr<cv::aruco::DetectorParameters>(parameters), rejected);
#endif
}

cv::Mat picture_of(cv::aruco::Dictionary const& dictionary, int id, int side_px)
{
    cv::Mat picture;
#if LIGHTWELL_OPENCV >= 407
    dictionary.generateImageMarker(id, side_px, picture, 1);
#else
    dictionary.drawMarker(id, side_px, picture, 1);
#endif
    return picture;
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

/// Detection by OpenCV, for all cases that do not use the AprilTag library.
FoundMarkers find_squares(cv::Mat const& searched, std::string const& dictionary, double longest_px,
                          SearchSettings const& s)
{
    cv::aruco::DetectorParameters p;
    p.minMarkerPerimeterRate = 4 * s.smallest_side_px / longest_px;
    p.maxMarkerPerimeterRate = 4;
    p.adaptiveThreshWinSizeMin = s.smallest_window_px;
    p.adaptiveThreshWinSizeMax = s.largest_window_px;
    p.adaptiveThreshWinSizeStep = s.window_step_px;
    p.perspectiveRemovePixelPerCell = 8; // more small markers are read than with 4 (docs/decisions/markers.md)
    if (s.refinement == Refinement::contour) p.cornerRefinementMethod = cv::aruco::CORNER_REFINE_CONTOUR;
    if (s.refinement == Refinement::apriltag) p.cornerRefinementMethod = cv::aruco::CORNER_REFINE_APRILTAG;
    Corners corners, rejected;
    std::vector<int> ids;
    detect(searched, dictionary_named(dictionary), p, corners, ids, rejected);
    FoundMarkers found;
    found.rejected = int(rejected.size());
    std::size_t const turn = is_apriltag(dictionary) ? 2 : 0; // OpenCV's stand on their heads
    for (std::size_t i = 0; i < ids.size(); ++i) {
        FoundMarker m{ids[i], {}};
        for (std::size_t k = 0; k < 4; ++k) {
            m.corners[k] = corners[i][(k + turn) % 4];
            // This search has (0, 0) at the upper left edge of the first pixel.
            if (s.refinement == Refinement::apriltag) m.corners[k] -= cv::Point2f(0.5f, 0.5f);
        }
        found.markers.push_back(m);
    }
    return found;
}

} // namespace

FoundMarkers find_markers(cv::Mat const& gray, std::string const& dictionary, SearchSettings const& s)
{
    cv::Mat searched = gray;
    if (s.enlarge > 1) cv::resize(gray, searched, {}, s.enlarge, s.enlarge, cv::INTER_CUBIC);
    bool const by_library = is_apriltag(dictionary) && s.refinement != Refinement::contour &&
                            s.refinement != Refinement::apriltag; // these two are searches of OpenCV's
    double const longest = std::max(gray.cols, gray.rows);        // the rates are of this
    FoundMarkers found = by_library ? find_apriltags(searched, dictionary, s.smallest_side_px < 16 ? 1 : 2)
                                    : find_squares(searched, dictionary, longest, s);
    for (FoundMarker& m : found.markers) {
        float const by = 1 / float(std::max(1, s.enlarge));
        for (cv::Point2f& c : m.corners) c = by * (c + cv::Point2f(0.5f, 0.5f)) - cv::Point2f(0.5f, 0.5f);
        auto const cells = cells_of(dictionary, m.id);
        if (s.refinement == Refinement::subpixel) refine(gray, m.corners, int(cells.size()));
        if (s.refinement == Refinement::edges) refine_by_edges(gray, m.corners, cells);
    }
    return found;
}

std::vector<std::vector<bool>> cells_of(std::string const& dictionary, int id)
{
    cv::aruco::Dictionary const codes = dictionary_named(dictionary);
    int const n = codes.markerSize + 2;
    cv::Mat picture = picture_of(codes, id, n);
    if (is_apriltag(dictionary)) cv::rotate(picture, picture, cv::ROTATE_180);
    std::vector<std::vector<bool>> cells(codes.markerSize + 2u, std::vector<bool>(codes.markerSize + 2u));
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) cells[std::size_t(y)][std::size_t(x)] = picture.at<std::uint8_t>(y, x) == 0;
    return cells;
}

} // namespace ar
