#pragma once
// Files that appear whole or not at all, and stay after a loss of power.

#include <filesystem>
#include <string_view>

namespace gi {

/// Writes a temporary file beside it, hands it to the disk (fsync), renames it, and makes the name durable.
/// @throws InputError naming the file; then nothing has changed
void write_durably(std::filesystem::path const& file, std::string_view text);
/// Makes the names in a folder durable; no harm where that cannot be had.
void sync_folder(std::filesystem::path const& folder);
/// Missing folders on the way are made too, and are durable. @throws InputError
void make_folder(std::filesystem::path const& folder);

} // namespace gi
