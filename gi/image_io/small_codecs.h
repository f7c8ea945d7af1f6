#pragma once
// PNG, JPEG and BMP by stb_image, where OpenCV's module imgcodecs is not installed: its 120 libraries do not fit into a
// Python wheel. A JPEG's pixels differ from OpenCV's by a few of 255.

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

namespace gi {

/// As cv::imdecode, with its flags: BGR, 8 or 16 bits. Empty if the format is another one or the file is damaged.
cv::Mat decode_small(std::span<unsigned char const> bytes, int flags);

/// As cv::imencode, of ".png", ".jpg" and ".bmp" with 8 bits a channel. Empty for others.
std::vector<unsigned char> encode_small(std::string const& extension, cv::Mat const& bgr, int jpeg_quality);

} // namespace gi
