#include "viewer/displays/edid.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace viewer {
namespace {

constexpr std::size_t kBlock = 128, kFirstDescriptor = 54, kDescriptor = 18, kDescriptors = 4;

/// 13 characters, ended by a line feed and filled with blanks.
std::string descriptor_text(std::vector<unsigned char> const& b, std::size_t at)
{
    std::string text;
    for (std::size_t i = at + 5; i < at + kDescriptor && b[i] != '\n'; ++i)
        text += b[i] >= 0x20 && b[i] < 0x7f ? char(b[i]) : ' ';
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

/// The number of a kernel's connector that X11 names without its letter: HDMI-A-1 is HDMI-1.
std::string x_name(std::string const& kernel)
{
    auto const dash = kernel.find("-A-");
    return dash == std::string::npos ? kernel : kernel.substr(0, dash) + kernel.substr(dash + 2);
}

} // namespace

std::optional<MonitorIdentity> parse_edid(std::vector<unsigned char> const& b)
{
    constexpr unsigned char kHeader[]{0, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0};
    if (b.size() < kBlock || !std::equal(std::begin(kHeader), std::end(kHeader), b.begin())) return {};
    unsigned sum = 0;
    for (std::size_t i = 0; i < kBlock; ++i) sum += b[i];
    if (sum % 256 != 0) return {};
    MonitorIdentity m;
    unsigned const maker = unsigned(b[8]) << 8 | b[9];
    for (int shift : {10, 5, 0}) m.maker += char('A' - 1 + (maker >> shift & 31));
    m.name = fmt::format("{} {:04x}", m.maker, unsigned(b[11]) << 8 | b[10]);
    unsigned const serial = unsigned(b[15]) << 24 | unsigned(b[14]) << 16 | unsigned(b[13]) << 8 | b[12];
    if (serial != 0) m.serial = std::to_string(serial);
    m.year = 1990 + b[17];
    m.width_cm = b[21];
    m.height_cm = b[22];
    for (std::size_t i = 0; i < kDescriptors; ++i) {
        std::size_t const at = kFirstDescriptor + i * kDescriptor;
        if (b[at] != 0 || b[at + 1] != 0) {
            if (i == 0) { // the preferred mode has the size in millimetres
                m.width_cm = 0.1 * (b[at + 12] | (b[at + 14] & 0xf0) << 4);
                m.height_cm = 0.1 * (b[at + 13] | (b[at + 14] & 0x0f) << 8);
            }
            continue;
        }
        if (b[at + 3] == 0xfc) m.name = descriptor_text(b, at);
        if (b[at + 3] == 0xff) m.serial = descriptor_text(b, at);
    }
    return m;
}

std::optional<MonitorIdentity> monitor_at(std::string const& connector, std::filesystem::path const& drm)
{
    std::error_code failed;
    for (std::filesystem::directory_iterator it(drm, failed), end; !failed && it != end; it.increment(failed)) {
        std::string const name = it->path().filename().string(); // card0-DP-1
        auto const dash = name.find('-');
        if (!name.starts_with("card") || dash == std::string::npos) continue;
        std::string const of = name.substr(dash + 1);
        if (of != connector && x_name(of) != connector) continue;
        std::ifstream in(it->path() / "edid", std::ios::binary);
        std::vector<unsigned char> const bytes{std::istreambuf_iterator<char>(in), {}};
        if (auto const m = parse_edid(bytes)) return m;
    }
    return {};
}

std::string to_text(MonitorIdentity const& m)
{
    return m.name + (m.serial.empty() ? "" : " " + m.serial) + (m.year > 1990 ? fmt::format(" ({})", m.year) : "");
}

} // namespace viewer
