#pragma once
// One picture of a flat board for calibration: points of the board and where they are seen.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"
#include "ar/markers/marker_map.h"

#include <optional>

namespace ar {

inline constexpr std::size_t kFewestPoints = 6; ///< minimum points per view for fitting a lens

struct BoardView {
    std::string name;                ///< of the picture, for messages
    std::vector<glm::dvec3> board_m; ///< z = 0, in the board's frame (marker_map.h)
    std::vector<glm::dvec2> pixels;
};

/// Returns the sighting's points on board number `board` (index into map.boards).
BoardView view_of(Sighting const& sighting, MarkerMap const& map, std::size_t board, std::string name);

/// Detects a plain chessboard by cv::findChessboardCornersSB (Duda and Frese 2018);
/// nothing unless it is fully visible.
/// @param corners_x,corners_y inner corners, each at least 3. The origin is the lower left inner corner as
/// printed, as far as the board's pattern determines its orientation
std::optional<BoardView> find_chessboard(cv::Mat const& gray, int corners_x, int corners_y, double square_m,
                                         std::string name);

/// Pose of the board by least squares of the reprojection error; nothing for fewer than
/// four points or if no pose fits them.
std::optional<gi::RigidPose> camera_from_board(CameraModel const& camera, BoardView const& view);

/// Observed minus projected position in pixels; (1e3, 1e3) for points outside the camera's view.
std::vector<glm::dvec2> residuals(CameraModel const& camera, gi::RigidPose const& camera_from_board,
                                  BoardView const& view);
double rms(std::vector<glm::dvec2> const& residuals);

} // namespace ar
