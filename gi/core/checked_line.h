#pragma once
// Lines of JSON that end with their checksum: {"n":12, ..., "crc32":"89abcdef"}. The checksum is the CRC-32 of
// gzip over the line up to `,"crc32"`. An incomplete line, as a killed process or a full disk leaves it, has none.

#include <string>
#include <string_view>

namespace gi {

/// @param object  a JSON object with one key at least, on one line
std::string checked_line(std::string object);
/// True if a line ends like a complete one, with a checksum.
bool has_checksum(std::string_view line);
/// True if it has a checksum, which is that of the line.
bool checksum_holds(std::string_view line);

} // namespace gi
