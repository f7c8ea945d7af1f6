#pragma once
// Which identifiers pictures show, and which the map has: a wrong first_id leaves a board unknown, or places it a few
// rows away.

#include "ar/markers/marker_map.h"

#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>

namespace ar {

using SeenIds = std::map<std::string, std::set<int>>; ///< by dictionary

/// Markers of a dictionary that the map does not name: of all dictionaries that which has most in the picture, and the
/// smallest of those. @param gray  CV_8UC1. @return nothing: none has three or more
struct OtherDictionary {
    std::string name;
    std::set<int> ids;
};
std::optional<OtherDictionary> other_dictionary(cv::Mat const& gray, MarkerMap const& map);

/// "0 to 9, 12": runs of numbers.
std::string ranges_of(std::set<int> const& numbers);

/// What contradicts the map: identifiers of its dictionaries that it does not have, and what it has; with a first_id
/// that fits where the identifiers are as many as those of a board or grid. Empty: all that were seen are in the map,
/// or there are none.
struct IdFinding {
    std::string problem; ///< "identifiers 0 to 16 of DICT_4X4_50 were seen, the map has 10 to 26"
    std::string remedy;  ///< "write first_id: 0 for board 1 (7 x 5 squares)"; may be empty
};
IdFinding compare_ids(SeenIds const& seen, MarkerMap const& map);

} // namespace ar
