#pragma once
// Checks that a compressed picture is complete: decoders fill missing data with grey without an error.

#include <cstdint>
#include <span>
#include <string>

namespace ar {

/// Returns what is missing; empty if the picture is complete. JPEG: begins with SOI, and EOI follows the last scan
/// (cameras may append zeros). PNG: chunks with valid checksums up to IEND. Other formats are not checked: empty.
std::string what_is_missing(std::span<std::uint8_t const> picture);
bool is_jpeg(std::span<std::uint8_t const> picture);
bool is_exr(std::span<std::uint8_t const> picture);
/// True if the first bytes are those of JPEG, PNG, BMP, TIFF, PNM or WebP. Other data must not be passed to
/// OpenCV, which tries every decoder: its DICOM decoder terminates the process on bad bytes.
bool is_picture(std::span<std::uint8_t const> bytes);

} // namespace ar
