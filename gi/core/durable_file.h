#pragma once
// Files that appear whole or not at all, and stay after a loss of power.

#include <filesystem>
#include <span>
#include <string_view>

namespace gi {

/// Whether to wait until the disk has a file. Where not, a loss of power soon after may cost it, and on file
/// systems that give a new name to data that is not on the disk also the file before it (not on ext4 and btrfs).
enum class DiskWait : bool { no, yes };

/// Writes a temporary file beside it, hands it to the disk (fsync), renames it, and makes the name durable.
/// Where the file system can (O_TMPFILE), the temporary has no name, so that nothing
/// stays of it if the program is killed.
/// @throws InputError naming the file; then nothing has changed
void write_durably(std::filesystem::path const& file, std::string_view text);
/// The same; writes the parts one after the other.
void write_durably(std::filesystem::path const& file, std::span<std::string_view const> parts,
                   DiskWait wait = DiskWait::yes);
/// Makes the names in a folder durable; no harm where that cannot be had.
void sync_folder(std::filesystem::path const& folder);
/// Missing folders on the way are made too, and are durable. @throws InputError
void make_folder(std::filesystem::path const& folder);

} // namespace gi
