#pragma once
// A picture against its reference: every metric by name, and a picture of the difference.

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
    std::vector<std::string> notes; ///< what was averaged down, left out, ...
};

/// @param names from metrics(); empty = those by default
/// @param layer compared; "color" is the beauty
/// If the sizes differ by a whole factor the larger picture is averaged down. Throws InputError on unknown
/// metrics, missing layers (it names those that are there) and sizes that do not fit.
Comparison compare(Picture const& image, Picture const& reference, std::vector<std::string> const& names,
                   std::string const& layer);

/// FLIP per pixel in the magma-like scale of the papers' figures, black = no difference.
std::vector<unsigned char> difference_image(Picture const& image, Picture const& reference,
                                            std::string const& layer, int& width, int& height);

} // namespace gi
