#pragma once
// The plan of a batch as text: a line about all tasks, then one per task (gi/core/checked_line.h).

#include "viewer/batch/task.h"

#include <optional>

namespace viewer::batch {

std::string text_of_batch(Batch const& batch);
/// NAME-1a2b3c4d: the hash is that of the keys of its tasks.
std::string batch_id(Batch const& batch);
/// @param only  index of the one task to read; all others are left out
/// @throws InputError with the line: damaged, or there is no such task
Batch batch_of_text(std::string const& text, std::string const& file, std::optional<std::size_t> only = {});

} // namespace viewer::batch
