#pragma once
// What identifies the content of a file: its SHA-256 and the time of its last change.

#include <cstdint>
#include <filesystem>
#include <string>

namespace viewer::batch {

/// SHA-256 of a regular file. @throws InputError it cannot be read
std::string file_sha256(std::filesystem::path const& file);
/// Time of the last change of a file's content, ns since 1970; 0 = unknown.
std::int64_t changed_ns(std::filesystem::path const& file);

} // namespace viewer::batch
