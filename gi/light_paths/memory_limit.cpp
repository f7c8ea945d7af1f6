#include "gi/light_paths/memory_limit.h"

#include "gi/core/error.h"

#include <fmt/format.h>

namespace gi {

void check_bytes(std::uint64_t bytes, std::string_view what, std::string_view instead)
{
    if (bytes > kMostBytes)
        throw InputError(fmt::format("{} of {:.1f} GiB", what, double(bytes) / double(1 << 30)),
                         fmt::format("at most {} GiB are supported", kMostBytes >> 30), std::string(instead));
}

} // namespace gi
