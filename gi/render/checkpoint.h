#pragma once
// The exact state of an unfinished render as a file: sums over paths in the order of PixelMeans.

#include "gi/render/accumulator.h"

#include <filesystem>

namespace gi {

/// Size of a checkpoint of such a picture.
std::uint64_t checkpoint_bytes(int width, int height);
/// Replaces the file at once (write_durably); the disk keeps a tenth of that size free, else InputError.
/// @param fingerprint  of scene, camera and settings; a checkpoint with another one is refused (InputError)
void save_checkpoint(std::filesystem::path const& file, Accumulator const& a, std::uint64_t fingerprint);
/// Returns false if the file does not exist. Throws InputError if it belongs to another render or is damaged.
bool load_checkpoint(std::filesystem::path const& file, Accumulator& a, std::uint64_t fingerprint);

} // namespace gi
