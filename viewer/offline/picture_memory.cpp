#include "viewer/offline/picture_memory.h"

#include "gi/core/error.h"
#include "gi/render/checkpoint.h"
#include "viewer/base/standard_streams.h"

#include <fmt/format.h>
#include <fstream>

namespace viewer {
namespace {

/// Memory and swap that programs can still get, of /proc/meminfo; 0 = not known.
std::uint64_t available_bytes()
{
    std::ifstream in("/proc/meminfo");
    std::uint64_t sum_kib = 0, kib = 0;
    for (std::string name, unit; in >> name >> kib; std::getline(in, unit))
        if (name == "MemAvailable:" || name == "SwapFree:") sum_kib += kib;
    return sum_kib * 1024;
}

} // namespace

PictureMemory picture_memory(int width, int height)
{
    return {std::uint64_t(width) * std::uint64_t(height) * sizeof(gi::PixelMeans),
            gi::checkpoint_bytes(width, height)};
}

std::string text_of_bytes(std::uint64_t bytes)
{
    if (bytes >= 1'000'000'000) return fmt::format("{:.1f} GB", double(bytes) * 1e-9);
    if (bytes >= 1'000'000) return fmt::format("{:.1f} MB", double(bytes) * 1e-6);
    return fmt::format("{} bytes", bytes);
}

void check_picture_memory(int width, int height)
{
    constexpr std::uint64_t kLarge = 1'000'000'000;
    std::uint64_t const needed = picture_memory(width, height).sums_bytes, available = available_bytes();
    if (available > 0 && needed > available)
        throw gi::InputError(
            fmt::format("a picture of {} x {} pixels does not fit into memory", width, height),
            fmt::format("it needs {}, and {} are available", text_of_bytes(needed), text_of_bytes(available)),
            "choose a smaller --size, or end other programs");
    if (needed >= kLarge)
        say(fmt::format("{} x {} pixels take {} of memory besides the scene", width, height,
                        text_of_bytes(needed)));
}

} // namespace viewer
