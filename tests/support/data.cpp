#include "tests/support/data.h"

namespace gi::test {

std::filesystem::path shared_data()
{
    std::filesystem::path const folder = std::filesystem::path(LIGHTWELL_SOURCE_DIR) / ".." / "shared" / "data";
    return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

} // namespace gi::test
