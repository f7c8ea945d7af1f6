#pragma once
#include <array>
#include <string>
#include <unistd.h>

namespace gi {

/// Name of this machine; "unknown" if it has none.
inline std::string host_name()
{
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

} // namespace gi
