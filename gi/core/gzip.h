#pragma once
// Whole texts packed by gzip (RFC 1952).

#include <string>
#include <string_view>

namespace gi {

/// The same bytes for the same text: no time, no name.
std::string gzip(std::string_view text);
/// All members of a file. @param file  named in the message   @param max_bytes  of the text
/// @throws InputError the bytes are no gzip file, are cut off or damaged, or the text is longer
std::string gunzip(std::string_view bytes, std::string const& file, std::size_t max_bytes = std::size_t(4) << 30);

} // namespace gi
