#pragma once
// Decodes a picture file's bytes to the pixels of a frame, with all its bits.

#include "ar/camera/frame.h"

#include <span>

namespace ar {

struct DecodedPicture {
    cv::Mat pixels = {}; ///< as a frame of `format` has them
    PixelFormat format = PixelFormat::bgr8;
    std::string problem = {};            ///< why it cannot be used; empty = none
    std::vector<std::string> notes = {}; ///< what was chosen, cut or converted (gi::Picture::notes)
};

/// PNG, JPEG, TIFF, BMP, PNM, WebP: bgr8, gray8; with 16 bits rgb16 (grey ones too), float TIFF rgb_linear.
/// OpenEXR: rgb_linear, of its channels R, G, B without a layer, or Y, in its display window. Never throws at bad
/// bytes. @param is_matte  the channel A of OpenEXR will do too
DecodedPicture decoded_picture(std::span<std::uint8_t const> bytes, bool is_matte = false);

} // namespace ar
