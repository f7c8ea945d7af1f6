#pragma once
// Filtering and saving of every rendered picture.

#include "viewer/bench/pictures_plan.h"
#include "viewer/bench/sweep_reference.h"

namespace viewer {

struct FilteredPicture {
    gi::Picture picture;
    double seconds = 0;       ///< time of the filter
    bool no_variance = false; ///< the filter needs a variance and changed nothing
};
FilteredPicture filtered(gi::Picture picture, PictureFilter const& filter);

struct PictureFiles {
    std::string picture, flip_map; ///< file names within the folder
};
PictureFiles save_pictures(gi::Picture const& picture, SweepReference const& reference,
                           std::filesystem::path const& folder, std::string const& stem);

} // namespace viewer
