#pragma once
// Whether a PNG shows what its picture holds: it has one fixed range, and pictures of skies in kcd/m2 lie far beyond.

#include "gi/image_io/picture.h"

#include <string>
#include <vector>

namespace viewer {

class ShownRange {
public:
    /// Of some rows. @param bytes  display-encoded, their layer "color" with as many channels
    void add(gi::Layer const& color, std::vector<unsigned char> const& bytes);
    /// What is wrong with a PNG most of whose pixels are white or black, and which exposure would show it; empty = nothing.
    /// @param exposure_ev  that it has, stops
    std::string problem(std::string const& file, double exposure_ev) const;

private:
    std::size_t pixels_ = 0, white_ = 0, black_ = 0;
    std::vector<float> logs_; ///< log2 of the luminance of some pixels
};

} // namespace viewer
