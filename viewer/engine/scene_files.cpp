#include "viewer/engine/scene_files.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/xxhash.h"

#include <fmt/format.h>

namespace viewer {
namespace {

std::string hash_of(std::string const& file)
{
    try {
        auto const bytes = gi::read_bytes(file);
        return fmt::format("{:016x}", gi::xxh64(std::as_bytes(std::span(bytes))));
    } catch (gi::InputError const&) {
        return "";
    }
}

} // namespace

FileHashes hashes_of(std::span<std::string const> files)
{
    constexpr std::size_t kMostText = std::size_t(256) << 10, kAround = 32; // bytes; of a hash, quotes and commas
    FileHashes hashes;
    std::size_t text = 0;
    // Loaders put the scene's own file first or last, and what it refers to between.
    auto const add = [&](std::string const& file) {
        if (hashes.contains(file) || (text += file.size() + kAround) > kMostText) return;
        hashes[file] = hash_of(file);
    };
    if (!files.empty()) add(files.back());
    for (std::string const& file : files) add(file);
    return hashes;
}

FileHashes file_hashes_from_json(nlohmann::json const& value)
{
    try {
        return value.get<FileHashes>();
    } catch (nlohmann::json::exception const& e) {
        throw gi::InputError("the hashes of a scene's files cannot be read", e.what(), "record the walk again");
    }
}

std::vector<std::string> changed_files(FileHashes const& recorded)
{
    std::vector<std::string> changed;
    for (auto const& [file, hash] : recorded) {
        std::string const now = hash_of(file);
        if (now != hash) changed.push_back(now.empty() ? file + " (missing)" : file);
    }
    return changed;
}

} // namespace viewer
