#pragma once
// Comparison of a picture with its reference: all metrics by name, and a picture of the difference.

#include "gi/image_io/picture.h"

#include <span>
#include <string_view>

namespace gi {

struct MetricInfo {
    std::string_view name;
    std::string_view meaning; ///< one line for --help
    bool by_default;
};

std::span<MetricInfo const> metrics();

struct NamedValue {
    std::string name; ///< "relmse", "bias.r", "ztest.beyond_3", ...
    double value;
};

struct Comparison {
    std::vector<NamedValue> values;
    std::vector<std::string> notes; ///< what was downsampled, omitted, ...
};

/// @param names from metrics(); empty = the default ones
/// @param layer  to compare; "color" is the full picture
/// If the sizes differ by an integer factor, the larger picture is downsampled by averaging. Throws InputError on
/// unknown metrics, missing layers (listing the existing ones) and incompatible sizes.
Comparison compare(Picture const& image, Picture const& reference, std::vector<std::string> const& names,
                   std::string const& layer);

/// Returns FLIP per pixel as bytes in the magma-like colour scale of the papers, black = no difference.
std::vector<unsigned char> difference_image(Picture const& image, Picture const& reference,
                                            std::string const& layer, int& width, int& height);

} // namespace gi
