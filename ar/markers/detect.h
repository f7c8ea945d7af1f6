#pragma once
// Detects which markers of a map a picture shows, and the pixel positions of their points.

#include "ar/camera/sighting.h"
#include "ar/markers/board_check.h"

#include <cstdint>
#include <map>

namespace ar {

struct DetectorSettings {
    Refinement refinement = Refinement::edges;
    /// Markers with shorter sides are ignored; 0: chosen by the picture's size (see search_settings).
    double smallest_side_px = 0;
    /// 2 finds markers with sides below 25 pixels more often, in twice the time (docs/decisions/markers.md).
    int enlarge = 1;
    /// MarkerTracker: searches the whole picture every this many pictures, for markers that came into view;
    /// 0 = never.
    int whole_picture_every = 15;
    /// MarkerTracker: margin in pixels around the last known region of the markers; 0: a fortieth of the
    /// picture's width, plus their motion between the last two pictures.
    double margin_px = 0;
};

/// Search settings for pictures of this size; the windows suit widths from 640 to 1920 pixels.
SearchSettings search_settings(DetectorSettings const& settings, cv::Size picture);

/// What the pictures so far said about a board or grid.
struct BoardMemory {
    BoardFinding last; ///< `agrees`: it is confirmed
    int against = 0;   ///< pictures in a row that contradict a confirmed one
};

/// Searches the whole picture. Points are corners of markers and inner corners of boards (boards use the corners
/// of their markers only if fewer than four inner corners are seen). Boards and grids that the picture contradicts
/// (check_board) have no points.
/// @param gray CV_8UC1. @throws gi::InputError wrong type, an empty picture, a map that `check` refuses
Sighting detect(cv::Mat const& gray, MarkerMap const& map, DetectorSettings const& settings = {});

/// Detects markers in successive pictures of one camera: searches near their last position, and the whole picture
/// if that finds fewer markers than before. (Thresholds depend on the searched
/// region: a barely visible marker may be found in one and not in the other.)
class MarkerTracker {
public:
    /// @throws gi::InputError a map that `check` refuses
    explicit MarkerTracker(MarkerMap map, DetectorSettings settings = {});

    /// @throws gi::InputError as detect
    Sighting next(cv::Mat const& gray);
    /// Forgets the last positions.
    void reset();

    struct Counts {
        std::uint64_t pictures = 0;
        std::uint64_t whole = 0;   ///< pictures searched as a whole
        std::uint64_t in_vain = 0; ///< of `whole`: after the local search had found too few
    };
    Counts const& counts() const { return counts_; }
    MarkerMap const& map() const { return map_; }

private:
    MarkerMap map_;
    DetectorSettings settings_;
    Counts counts_;
    cv::Size size_;
    cv::Rect2f last_{}, before_{}; ///< bounds of the markers in the last two pictures; empty: unknown
    int seen_ = 0;                 ///< markers in the last picture
    std::map<int, BoardMemory> known_; ///< of boards and grids, by thing
    int since_whole_ = 0;
};

} // namespace ar
