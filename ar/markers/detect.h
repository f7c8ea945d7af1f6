#pragma once
// Pictures to sightings: which markers of a map are seen, and where their points are.

#include "ar/camera/sighting.h"
#include "ar/markers/aruco.h"

#include <cstdint>

namespace ar {

struct DetectorSettings {
    Refinement refinement = Refinement::edges;
    /// Markers whose sides are shorter are not found; 0: chosen by the picture's size (see search_settings).
    double smallest_side_px = 0;
    /// 2: markers with sides below 25 pixels are found more often, for twice the time (docs/results).
    int enlarge = 1;
    /// MarkerTracker: every so many pictures is searched as a whole, for markers that came into view; 0 = never.
    int whole_picture_every = 15;
    /// MarkerTracker: how far beyond the last place of the markers is searched, pixels; 0: a fortieth of the
    /// picture's width, and the way they went since the last picture but one.
    double margin_px = 0;
};

/// What pictures of this size need: windows that suit 640 to 1920 pixels.
SearchSettings search_settings(DetectorSettings const& settings, cv::Size picture);

/// The whole picture. Points are corners of markers and inner corners of boards (of boards nothing else, unless
/// fewer than four of these are seen: then the corners of their markers).
/// @param gray CV_8UC1. @throws gi::InputError another type, an empty picture, a map that `check` refuses
Sighting detect(cv::Mat const& gray, MarkerMap const& map, DetectorSettings const& settings = {});

/// Pictures of one camera one after another: looks where the markers were, and at the whole picture where that
/// finds fewer of them than before. (Thresholds depend on the part
/// that is searched: a marker that is hardly seen may be found in one and not in the other.)
class MarkerTracker {
public:
    /// @throws gi::InputError a map that `check` refuses
    explicit MarkerTracker(MarkerMap map, DetectorSettings settings = {});

    /// @throws gi::InputError as detect
    Sighting next(cv::Mat const& gray);
    /// Forget where they were.
    void reset();

    struct Counts {
        std::uint64_t pictures = 0;
        std::uint64_t whole = 0;   ///< of these searched as a whole
        std::uint64_t in_vain = 0; ///< of these after the search nearby had found too few
    };
    Counts const& counts() const { return counts_; }
    MarkerMap const& map() const { return map_; }

private:
    MarkerMap map_;
    DetectorSettings settings_;
    Counts counts_;
    cv::Size size_;
    cv::Rect2f last_{}, before_{}; ///< around the markers of the last picture and the one before; empty: unknown
    int seen_ = 0;                 ///< markers in the last picture
    int since_whole_ = 0;
};

} // namespace ar
