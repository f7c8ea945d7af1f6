#pragma once
// Two pictures made comparable: one layer of each, in one size, with three channels.

#include "gi/image_io/picture.h"

namespace gi {

struct PicturePair {
    int width, height;
    std::vector<float> image, reference;                   ///< 3 * width * height values, as they are
    Layer finite_image, finite_reference;                  ///< both 0 where one of the two is not finite
    std::vector<float> image_variance, reference_variance; ///< empty where there is none
    std::vector<std::string> notes;                        ///< what was averaged down or left out
};

/// Throws InputError where a picture lacks the layer, the sizes are no whole multiples of each other, or no value
/// is finite in both.
PicturePair pair_up(Picture const& image, Picture const& reference, std::string const& layer);

/// For metrics of displays: everything in [0, 1].
std::vector<float> clipped(Layer const& layer);

} // namespace gi
