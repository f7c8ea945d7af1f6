#pragma once
// Two pictures made comparable: one layer of each, at the same size, with three channels.

#include "gi/image_io/picture.h"

namespace gi {

struct PicturePair {
    int width, height;
    std::vector<float> image, reference;                   ///< 3 * width * height values, unchanged
    Layer finite_image, finite_reference;                  ///< both 0 where either is not finite
    std::vector<float> image_variance, reference_variance; ///< empty if the picture has no variance
    std::vector<std::string> notes;                        ///< what was downsampled or omitted

    /// True if all three values of the pixel are finite in both pictures.
    bool is_finite(std::size_t pixel) const;
};

/// Throws InputError if a picture lacks the layer, one size is not an integer multiple of the other,
/// or no value is finite in both.
PicturePair pair_up(Picture const& image, Picture const& reference, std::string const& layer);

/// Returns the values clipped to [0, 1], for metrics of displayed pictures.
std::vector<float> clipped(Layer const& layer);

} // namespace gi
