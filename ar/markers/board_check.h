#pragma once
// Whether a picture agrees with what the map says about a board or grid: where its markers lie to each other, how
// large they are, and which squares are black. A board that was printed otherwise than its map says - by OpenCV
// before 4.6, with rows and columns exchanged, in other sizes - still has all its markers, and gives poses that are
// off by a square.

#include "ar/markers/aruco.h"

namespace ar {

enum class BoardVerdict {
    silent,      ///< the picture shows too little to tell
    agrees,      ///< and other arrangements do not
    doubtful,    ///< only squares contradict the map, which something bright in front may cover, too
    contradicts, ///< the positions or sizes of markers do
};

struct BoardFinding {
    BoardVerdict verdict = BoardVerdict::silent;
    std::string problem; ///< if doubtful or contradicting: what the map says and the picture shows, a clause
    std::string remedy;  ///< what to write instead
};

/// Compares neighbouring markers with each other, so lenses and bent boards do no harm, and the squares beside
/// markers with their own black and white.
/// @param gray  CV_8UC1  @param thing  a board or grid of the map  @param found  its markers, each once
BoardFinding check_board(cv::Mat const& gray, MarkerMap const& map, int thing,
                         std::vector<FoundMarker> const& found);

} // namespace ar
