#pragma once
// Files that an interrupted attempt leaves for the next one of the same task, so that its work is not repeated.

#include "viewer/batch/task.h"

namespace viewer::batch {

/// Files, relative to the task's folder, from which the task's command goes on with --resume, to the very outputs
/// of an uninterrupted one: the state of a picture, or frames that are complete. Empty = it cannot.
std::vector<std::string> resumable_files(Task const& task);

} // namespace viewer::batch
