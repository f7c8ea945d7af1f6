#include "viewer/displays/vrpn_address.h"

#include "gi/core/text.h"

#include <algorithm>

namespace viewer {

constexpr std::size_t kLongestDevice = 100; ///< VRPN's own limit
constexpr std::size_t kLongestHost = 253;   ///< of the domain name system

std::optional<VrpnAddress> parse_vrpn_address(std::string_view text)
{
    VrpnAddress a;
    std::size_t const at = text.find('@');
    if (at == std::string_view::npos || at == 0 || at > kLongestDevice) return {};
    a.device = text.substr(0, at);
    std::string_view where = text.substr(at + 1);
    for (std::string_view const scheme : {"tcp://", "x-vrpn://", "vrpn://", "tcp:"})
        if (where.starts_with(scheme)) {
            where.remove_prefix(scheme.size());
            a.tcp_only = scheme.starts_with("tcp");
            break;
        }
    if (where.starts_with('[')) { // an IPv6 address
        std::size_t const end = where.find(']');
        if (end == std::string_view::npos) return {};
        a.host = where.substr(1, end - 1);
        where.remove_prefix(end + 1);
    } else {
        a.host = where.substr(0, where.find(':'));
        where.remove_prefix(a.host.size());
    }
    if (!where.empty()) {
        auto const port = where.front() == ':' ? gi::parse_number<std::uint64_t>(where.substr(1)) : std::nullopt;
        if (!port || *port < 1 || *port > 65535) return {};
        a.port = int(*port);
    }
    bool const is_text = std::all_of(text.begin(), text.end(), [](unsigned char c) { return c > ' ' && c < 127; });
    if (a.host.empty() || a.host.size() > kLongestHost || !is_text) return {};
    return a;
}

} // namespace viewer
