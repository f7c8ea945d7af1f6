#pragma once
// Batches made from a command line that would do all of the work alone.

#include "viewer/batch/task.h"

namespace viewer::batch {

/// `render SCENE --frames A:B@R ...`: a sequence, split after so many frames. Files that the command names are
/// inputs, and all files in the folder of a scene that may refer to others (glTF, OBJ, YAML, ...).
/// @param words after `lightwell` @throws InputError options that need all frames in one process
Batch batch_of_render(std::vector<std::string> const& words, int frames_per_task);

/// `bench sweep --scene A,B ...` or `bench pictures --scenes A,B ...`:
/// a task per scene, which has a machine to itself.
Batch batch_of_bench(std::vector<std::string> const& words);

} // namespace viewer::batch
