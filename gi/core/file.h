#pragma once
// Files appear whole or not at all.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

/// Call `write` with a temporary path beside `file`, then rename it to `file`. On any exception the
/// temporary is removed and the exception rethrown; a target folder that does not exist, is read-only or full
/// throws InputError naming the file.
void write_by_rename(std::filesystem::path const& file,
                     std::function<void(std::filesystem::path const&)> const& write);
void write_text(std::filesystem::path const& file, std::string_view text);
/// ".glb" of "Room.GLB"; empty if it has none.
std::string lower_extension(std::filesystem::path const& file);
/// Size of a file. Throws InputError if it does not exist, or is a folder, a device or a pipe: a device may have
/// no end, and a pipe nobody who writes to it.
std::uintmax_t regular_file_bytes(std::filesystem::path const& file);
/// The whole file. Throws like regular_file_bytes(), and if it is larger than max_bytes.
std::vector<unsigned char> read_bytes(std::filesystem::path const& file, std::size_t max_bytes = std::size_t(8)
                                                                                                 << 30);
/// The whole file as text, its bytes unchanged. Throws like read_bytes().
std::string read_text(std::filesystem::path const& file, std::size_t max_bytes = std::size_t(1) << 30);

} // namespace gi
