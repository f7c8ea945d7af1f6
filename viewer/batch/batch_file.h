#pragma once
// The plan of a batch as text: a line about all tasks, then one per task (gi/core/checked_line.h).

#include "viewer/batch/task.h"

#include <string_view>

namespace viewer::batch {

std::string text_of_batch(Batch const& batch);
/// Offsets of its lines, so that a process can read its task alone: 16 hexadecimal digits and a line end for each.
std::string index_of(std::string_view text);
/// NAME-1a2b3c4d: the hash is that of the keys of its tasks.
std::string batch_id(Batch const& batch);

/// @throws InputError with the line: damaged
Batch batch_of_text(std::string const& text, std::string const& file);
/// The plan with one task alone, from 0. @throws InputError damaged, or there is no such task
Batch batch_with_task(std::filesystem::path const& text_file, std::filesystem::path const& index_file,
                      std::size_t task);

} // namespace viewer::batch
