#include "viewer/report/html.h"

#include "gi/core/base64.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/html/html.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace viewer {
namespace {

constexpr char const* kNotMarked = "something else";

/// Reads whole files that have `mark` at byte `at`.  @return why not; empty = read
std::string read_marked(std::filesystem::path const& file, std::string_view mark, std::size_t at,
                        std::size_t least, std::vector<unsigned char>& bytes)
{
    constexpr std::size_t kMostBytes = std::size_t(64) << 20;
    try {
        bytes = gi::read_bytes(file, kMostBytes);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    bool const marked = bytes.size() >= std::max(least, at + mark.size()) &&
                        std::equal(mark.begin(), mark.end(), bytes.begin() + std::ptrdiff_t(at),
                                   [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; });
    return marked ? "" : kNotMarked;
}

std::string missing(std::string const& words) { return gi::html_paragraph(words, "missing"); }

} // namespace

std::string readable(std::string const& column_name)
{
    std::string name = column_name;
    for (std::string_view const unit : {"_ms", "_s", "_bytes", "_deg"})
        if (name.ends_with(unit) && !name.ends_with("_per_s"))
            return readable(name.substr(0, name.size() - unit.size())) + ", " + std::string(unit.substr(1));
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

std::string embedded_png(std::filesystem::path const& file, std::string const& description)
{
    constexpr std::size_t kSize = 16; // where its width and height stand
    std::vector<unsigned char> bytes;
    if (std::string const why = read_marked(file, "\x89PNG", 0, kSize + 8, bytes); !why.empty())
        return missing(why == kNotMarked ? file.filename().string() + " is no PNG" : why);
    auto const word = [&](std::size_t at) {
        return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
               std::uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
    };
    return fmt::format(
        "<img tabindex=\"0\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">", word(kSize),
        word(kSize + 4), gi::escaped(description), gi::encode_base64(bytes));
}

std::string linked_png(std::filesystem::path const& file, std::string const& description)
{
    return fmt::format("<img tabindex=\"0\" loading=\"lazy\" alt=\"{}\" src=\"{}\">", gi::escaped(description),
                       gi::escaped(file.filename().string()));
}

std::string embedded_video(std::filesystem::path const& file, std::string const& description)
{
    std::vector<unsigned char> bytes;
    if (std::string const why = read_marked(file, "ftyp", 4, 8, bytes); !why.empty())
        return missing(why == kNotMarked ? file.filename().string() + " is no MP4, and browsers would not play it"
                                         : why);
    return fmt::format("<video controls loop autoplay muted playsinline title=\"{}\" "
                       "src=\"data:video/mp4;base64,{}\"></video>",
                       gi::escaped(description), gi::encode_base64(bytes));
}

} // namespace viewer
