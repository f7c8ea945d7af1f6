#include "gi/render/checkpoint.h"

#include "gi/core/error.h"
#include "gi/core/processor_level.h"
#include "gi/core/xxhash.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <span>
#include <utility>

namespace gi {
namespace {

struct CheckpointHeader {
    char magic[8] = {'L', 'W', 'S', 'T', 'A', 'T', 'E', '5'};
    std::uint64_t fingerprint = 0;
    std::int32_t width = 0, height = 0;
    std::uint32_t paths = 0, pixel_bytes = sizeof(PixelMeans);
    PathCounts counts;
    double seconds = 0;
    std::uint32_t has_further = 0; ///< Accumulator::further follows the means
    std::uint32_t level =
        0; ///< of the program that traced its paths: 1 + its place in kProcessorLevels; 0 = other, or not known; kSeveral
    std::uint64_t hash = 0;        ///< of the whole file, with 0 here
};
static_assert(std::is_trivially_copyable_v<CheckpointHeader> && std::is_trivially_copyable_v<PixelMeans>);

constexpr std::size_t kTogether = 1 << 16; ///< pixels hashed, and read, together

template <class T>
std::uint64_t hash_of(std::span<T const> some, std::uint64_t before = 0)
{
    return xxh64(std::as_bytes(some), before);
}

/// Of the means, chunk by chunk, as they are read.
std::uint64_t hash_of_means(std::span<PixelMeans const> pixels, std::uint64_t hash)
{
    for (std::size_t at = 0; at < pixels.size(); at += kTogether)
        hash = hash_of(pixels.subspan(at, std::min(kTogether, pixels.size() - at)), hash);
    return hash;
}

constexpr std::uint32_t kSeveral = kProcessorLevels.size() + 1;

std::uint32_t own_level()
{
    auto const at = std::ranges::find(kProcessorLevels, std::string_view(kCompiledLevel),
                                      [](char const* level) { return std::string_view(level); });
    return at == kProcessorLevels.end() ? 0 : std::uint32_t(at - kProcessorLevels.begin()) + 1;
}

std::uint64_t further_bytes(std::vector<std::uint32_t> const& further)
{
    return further.size() * sizeof(std::uint32_t);
}

} // namespace

std::uint64_t checkpoint_bytes(int width, int height)
{
    return sizeof(CheckpointHeader) + std::uint64_t(width) * std::uint64_t(height) * sizeof(PixelMeans);
}

void save_checkpoint(std::filesystem::path const& file, Accumulator const& a, std::uint64_t fingerprint,
                     DiskWait wait)
{
    std::uint64_t const bytes = checkpoint_bytes(a.width, a.height) + further_bytes(a.further);
    std::error_code unknown;
    auto const disk = std::filesystem::space(file.has_parent_path() ? file.parent_path() : ".", unknown);
    if (!unknown && disk.available < bytes + bytes / 10)
        throw InputError("'" + file.string() + "' cannot be written",
                         fmt::format("it needs {} bytes, and the disk has {}", bytes, disk.available),
                         "free some space, or choose another folder");
    CheckpointHeader header;
    header.fingerprint = fingerprint;
    header.width = a.width;
    header.height = a.height;
    header.paths = a.paths;
    header.counts = a.counts;
    header.seconds = a.seconds;
    header.has_further = a.further.empty() ? 0 : 1;
    header.level = a.of_several_levels ? kSeveral : own_level();
    header.hash = hash_of<std::uint32_t>(
        a.further, hash_of_means(a.pixels, hash_of(std::span<CheckpointHeader const>(&header, 1))));
    std::string_view const parts[]{
        {reinterpret_cast<char const*>(&header), sizeof header},
        {reinterpret_cast<char const*>(a.pixels.data()), a.pixels.size() * sizeof(PixelMeans)},
        {reinterpret_cast<char const*>(a.further.data()), further_bytes(a.further)}};
    write_durably(file, parts, wait);
}

bool load_checkpoint(std::filesystem::path const& file, Accumulator& a, std::uint64_t fingerprint,
                     StopRequest const* stop, Report* report)
{
    if (file.empty() || !std::filesystem::exists(file)) return false;
    auto const damaged = [&](char const* why) {
        return InputError("'" + file.string() + "' is damaged", why, "delete it to start afresh");
    };
    std::ifstream in(file, std::ios::binary);
    CheckpointHeader header;
    CheckpointHeader const expected;
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    char const format = header.magic[7], known = expected.magic[7];
    if (!in || std::memcmp(header.magic, expected.magic, 7) != 0 || format < '0' || format > '9')
        throw InputError("'" + file.string() + "' is not a checkpoint", "it does not start like one",
                         "delete it to start afresh");
    if (format != known)
        throw InputError("'" + file.string() + "' is a checkpoint of another version",
                         fmt::format("its format is {}, this version reads {}", format, known),
                         "finish the picture with the version that began it, or delete the file to start afresh");
    if (header.fingerprint != fingerprint || header.width != a.width || header.height != a.height)
        throw InputError("'" + file.string() + "' belongs to another render",
                         "scene, camera, settings or method differ from when it was written, or another version "
                         "wrote it",
                         "delete it or drop --resume to start afresh; the version that wrote it can finish it");
    a.further.assign(header.has_further == 1 ? a.pixels.size() : 0, 0);
    if (header.pixel_bytes != sizeof(PixelMeans) || header.has_further > 1 || header.level > kSeveral ||
        std::filesystem::file_size(file) != checkpoint_bytes(a.width, a.height) + further_bytes(a.further))
        throw damaged("its size does not fit its header");
    std::uint64_t const expected_hash = std::exchange(header.hash, 0);
    std::uint64_t hash = hash_of(std::span<CheckpointHeader const>(&header, 1));
    for (std::size_t at = 0; in && at < a.pixels.size(); at += kTogether) {
        if (stop != nullptr && stop->requested()) throw Interrupted();
        std::span<PixelMeans> const some(&a.pixels[at], std::min(kTogether, a.pixels.size() - at));
        in.read(reinterpret_cast<char*>(some.data()), std::streamsize(some.size_bytes()));
        hash = hash_of<PixelMeans>(some, hash);
    }
    in.read(reinterpret_cast<char*>(a.further.data()), std::streamsize(further_bytes(a.further)));
    if (!in || hash_of<std::uint32_t>(a.further, hash) != expected_hash)
        throw damaged("its checksum is not that of its contents");
    a.paths = header.paths;
    a.counts = header.counts;
    a.seconds = header.seconds;
    a.of_several_levels = header.level != 0 && header.level != own_level();
    if (report != nullptr && a.of_several_levels)
        report->lose(
            "paths of programs for other levels of processors: the picture may differ in its last bits from an "
            "uninterrupted one",
            header.paths,
            fmt::format("{}; this is {}",
                        header.level == kSeveral ? "several levels" : kProcessorLevels[header.level - 1],
                        kCompiledLevel));
    return true;
}

} // namespace gi
