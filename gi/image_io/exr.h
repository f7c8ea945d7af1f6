#pragma once
// What the parts of the OpenEXR reader and writer share.

#include "gi/core/error.h"

#include <span>
#include <string>
#include <string_view>

namespace gi {

/// Metadata become string attributes of the first part, with this before their key.
inline constexpr std::string_view kMetadataPrefix = "lightwell:";

InputError bad_exr(std::string const& name, std::string const& why);

/// Throws InputError unless every attribute of every header has the size of its type and lies within the file.
void check_exr_header(std::span<unsigned char const> bytes, std::string const& name);

} // namespace gi
