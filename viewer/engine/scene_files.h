#pragma once
// The files that a scene was read from, with hashes of their bytes: a replay tells by them that the scene has changed
// since it was recorded.

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace viewer {

/// By name: XXH64 of the bytes, 16 hexadecimal digits; empty for what cannot be read.
using FileHashes = std::map<std::string, std::string>;

/// Of these files in their order, the scene's own among them, as many as fit into a recording's header: names and hashes
/// of 256 KiB together.
FileHashes hashes_of(std::span<std::string const> files);
/// Throws InputError if it is no object of texts.
FileHashes file_hashes_from_json(nlohmann::json const& value);
/// Those whose bytes are others now, by name; "(missing)" follows the names of files that can no longer be read.
std::vector<std::string> changed_files(FileHashes const& recorded);

} // namespace viewer
