#pragma once
// One picture of a flat board for calibration: points of the board and where they are seen.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"
#include "ar/markers/marker_map.h"

#include <optional>

namespace ar {

inline constexpr std::size_t kFewestPoints = 6; ///< of a view that a lens is fitted to

struct BoardView {
    std::string name;                ///< of the picture, for messages
    std::vector<glm::dvec3> board_m; ///< z = 0, in the board's frame (marker_map.h)
    std::vector<glm::dvec2> pixels;
};

/// What a sighting has of board number `board` (in map.boards).
BoardView view_of(Sighting const& sighting, MarkerMap const& map, std::size_t board, std::string name);

/// A plain chessboard by cv::findChessboardCornersSB (Duda and Frese 2018); nothing where it is not seen whole.
/// @param corners_x,corners_y inner corners, each at least 3; origin: the lower left of them as printed, as far as
/// the board tells its turn
std::optional<BoardView> find_chessboard(cv::Mat const& gray, int corners_x, int corners_y, double square_m,
                                         std::string name);

/// Where the board is, by least squares of pixels. Nothing for fewer than four points or where they fit no pose.
std::optional<Pose> camera_from_board(CameraModel const& camera, BoardView const& view);

/// Seen minus projected, pixels; points that the camera does not see are (1e3, 1e3) off.
std::vector<glm::dvec2> residuals(CameraModel const& camera, Pose const& camera_from_board, BoardView const& view);
double rms(std::vector<glm::dvec2> const& residuals);

} // namespace ar
