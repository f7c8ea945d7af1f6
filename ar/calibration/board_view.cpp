#include "ar/calibration/board_view.h"

#include <cmath>
#include <opencv2/calib3d.hpp>

namespace ar {
namespace {

double squared(std::vector<glm::dvec2> const& r)
{
    double sum = 0;
    for (auto const& v : r) sum += glm::dot(v, v);
    return sum;
}

/// Applies a small rotation and translation from the left.
gi::RigidPose moved(gi::RigidPose const& p, cv::Vec6d const& by)
{
    gi::RigidPose const d = pose_of({by[0], by[1], by[2]}, {0, 0, 0});
    return {p.position + glm::dvec3(by[3], by[4], by[5]), glm::normalize(d.rotation * p.rotation)};
}

/// Levenberg and Marquardt over the six numbers of a pose.
gi::RigidPose refined(CameraModel const& camera, gi::RigidPose pose, BoardView const& view)
{
    double damping = 1e-6, error = squared(residuals(camera, pose, view));
    for (int round = 0; round < 30; ++round) {
        auto const r = residuals(camera, pose, view);
        cv::Matx66d normal = cv::Matx66d::zeros();
        cv::Vec6d right;
        std::array<std::vector<glm::dvec2>, 6> slopes;
        double const scale = std::max(1e-3, glm::length(pose.position));
        for (int k = 0; k < 6; ++k) {
            double const h = 1e-6 * (k < 3 ? 1 : scale);
            cv::Vec6d step;
            step[k] = h;
            auto const plus = residuals(camera, moved(pose, step), view);
            auto const minus = residuals(camera, moved(pose, -step), view);
            for (std::size_t i = 0; i < r.size(); ++i)
                slopes[std::size_t(k)].push_back((plus[i] - minus[i]) / (2 * h));
        }
        for (int a = 0; a < 6; ++a)
            for (std::size_t i = 0; i < r.size(); ++i) {
                right[a] -= glm::dot(slopes[std::size_t(a)][i], r[i]);
                for (int b = 0; b < 6; ++b)
                    normal(a, b) += glm::dot(slopes[std::size_t(a)][i], slopes[std::size_t(b)][i]);
            }
        for (int a = 0; a < 6; ++a) normal(a, a) *= 1 + damping;
        cv::Vec6d step;
        if (!cv::solve(normal, right, step, cv::DECOMP_CHOLESKY)) break;
        gi::RigidPose const next = moved(pose, step);
        double const next_error = squared(residuals(camera, next, view));
        if (next_error < error) {
            bool const done = error - next_error < 1e-12 * error;
            pose = next;
            error = next_error;
            damping *= 0.1;
            if (done) break;
        } else {
            damping = std::max(1e-9, damping) * 10;
            if (damping > 1e6) break;
        }
    }
    return pose;
}

} // namespace

BoardView view_of(Sighting const& sighting, MarkerMap const& map, std::size_t board, std::string name)
{
    BoardView view;
    view.name = std::move(name);
    gi::RigidPose const board_from_world = inverse(map.boards.at(board).world_from_board);
    for (SightedPoint const& p : sighting.points) {
        if (p.marker != int(map.markers.size() + board)) continue;
        glm::dvec3 at = board_from_world * p.world_m;
        at.z = 0;
        view.board_m.push_back(at);
        view.pixels.push_back(p.pixel);
    }
    return view;
}

std::optional<BoardView> find_chessboard(cv::Mat const& gray, int corners_x, int corners_y, double square_m,
                                         std::string name)
{
    std::vector<cv::Point2f> corners;
    if (!cv::findChessboardCornersSB(gray, {corners_x, corners_y}, corners, cv::CALIB_CB_ACCURACY))
        return std::nullopt;
    BoardView view;
    view.name = std::move(name);
    for (int i = 0; i < int(corners.size()); ++i) {
        view.board_m.emplace_back((i % corners_x) * square_m, (corners_y - 1 - i / corners_x) * square_m, 0);
        view.pixels.emplace_back(corners[std::size_t(i)].x, corners[std::size_t(i)].y);
    }
    return view;
}

std::vector<glm::dvec2> residuals(CameraModel const& camera, gi::RigidPose const& camera_from_board,
                                  BoardView const& view)
{
    std::vector<glm::dvec2> out;
    for (std::size_t i = 0; i < view.pixels.size(); ++i) {
        auto const p = project(camera, camera_from_board * view.board_m[i]);
        out.push_back(p ? view.pixels[i] - *p : glm::dvec2(1e3));
    }
    return out;
}

double rms(std::vector<glm::dvec2> const& r) { return r.empty() ? 0 : std::sqrt(squared(r) / double(r.size())); }

std::optional<gi::RigidPose> camera_from_board(CameraModel const& camera, BoardView const& view)
{
    std::vector<cv::Point3d> board;
    std::vector<cv::Point2d> plane;
    for (std::size_t i = 0; i < view.pixels.size(); ++i) {
        auto const d = direction_of(camera, view.pixels[i]);
        if (!d || d->z < 0.02) continue; // more than 88 degrees off the axis
        board.emplace_back(view.board_m[i].x, view.board_m[i].y, 0);
        plane.emplace_back(d->x / d->z, d->y / d->z);
    }
    if (board.size() < 4) return std::nullopt;
    cv::Vec3d turn, shift;
    try {
        if (!cv::solvePnP(board, plane, cv::Matx33d::eye(), cv::noArray(), turn, shift, false, cv::SOLVEPNP_IPPE))
            return std::nullopt;
    } catch (cv::Exception const&) { // points on a line
        return std::nullopt;
    }
    gi::RigidPose const pose = refined(camera, pose_of(turn, shift), view);
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(pose.position[i])) return std::nullopt;
    return pose;
}

} // namespace ar
