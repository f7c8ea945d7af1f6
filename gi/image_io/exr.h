#pragma once
// Shared by the parts of the OpenEXR reader and writer.

#include "gi/core/error.h"

#include <span>
#include <string>
#include <string_view>

namespace gi {

/// Prefix of the keys of metadata, which are stored as string attributes of the first part.
inline constexpr std::string_view kMetadataPrefix = "lightwell:";

InputError bad_exr(std::string const& name, std::string const& why);

/// Throws InputError unless every attribute of every header has the size that its type
/// requires and lies within the file.
void check_exr_header(std::span<unsigned char const> bytes, std::string const& name);

} // namespace gi
