#pragma once
// Whether a compressed picture is all there: decoders fill what is missing with grey and say nothing.

#include <cstdint>
#include <span>
#include <string>

namespace ar {

/// Empty if it is whole, else what is missing. JPEG: begins with SOI, and EOI follows the last scan (cameras may
/// put zeros after it). PNG: chunks with right checksums up to IEND. Of other formats it knows nothing: empty.
std::string what_is_missing(std::span<std::uint8_t const> picture);
bool is_jpeg(std::span<std::uint8_t const> picture);
/// By its first bytes: JPEG, PNG, BMP, TIFF, PNM or WebP. Anything else must not be handed to OpenCV, which offers
/// it to every decoder there is: that of DICOM ends the process over bad bytes.
bool is_picture(std::span<std::uint8_t const> bytes);

} // namespace ar
