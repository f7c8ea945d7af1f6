#pragma once

namespace viewer {

/// Makes the process keep the memory that it frees: each frame needs the same amount, and mapping it
/// anew takes a quarter of a short frame. malloc_trim() gives it back where something large has ended.
/// Call before threads start.
void keep_freed_memory();

} // namespace viewer
