#include "gi/core/checked_line.h"

#include "gi/core/crc32.h"

#include <fmt/format.h>

namespace gi {
namespace {

constexpr std::string_view kSum = ",\"crc32\":\"";
constexpr std::size_t kSumLength = 20; // ,"crc32":"89abcdef"}

} // namespace

std::string checked_line(std::string object)
{
    object.pop_back(); // the brace
    std::uint32_t const sum = crc32(object);
    return std::move(object) + fmt::format("{}{:08x}\"}}", kSum, sum);
}

bool has_checksum(std::string_view line)
{
    return line.size() >= kSumLength && line.substr(line.size() - kSumLength, kSum.size()) == kSum &&
           line.ends_with("\"}");
}

bool checksum_holds(std::string_view line)
{
    if (!has_checksum(line)) return false;
    std::size_t const at = line.size() - kSumLength;
    return line.substr(at + kSum.size()) == fmt::format("{:08x}\"}}", crc32(line.substr(0, at)));
}

} // namespace gi
