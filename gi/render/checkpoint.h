#pragma once
// The exact state of an unfinished render as a file: sums over paths in the order of PixelMeans.

#include "gi/core/durable_file.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/render/accumulator.h"

#include <filesystem>

namespace gi {

/// Size of a checkpoint of such a picture; 4 bytes a pixel more after an interrupted pass.
std::uint64_t checkpoint_bytes(int width, int height);
/// Replaces the file as write_durably() does; the disk keeps a tenth of that size free, else InputError.
/// @param fingerprint  of scene, camera and settings; a checkpoint with another one is refused (InputError)
void save_checkpoint(std::filesystem::path const& file, Accumulator const& a, std::uint64_t fingerprint,
                     DiskWait wait = DiskWait::yes);
/// Returns false if the file does not exist. Throws InputError if it belongs to another render or is damaged.
/// @param stop  once it is requested, throws Interrupted; null = never
/// @param report  is told if its paths were traced by a program for another level of processors
bool load_checkpoint(std::filesystem::path const& file, Accumulator& a, std::uint64_t fingerprint,
                     StopRequest const* stop = nullptr, Report* report = nullptr);

} // namespace gi
