#pragma once
// The states of a batch's tasks, from the store alone.

#include "viewer/batch/journal.h"
#include "viewer/batch/store.h"

#include <map>
#include <set>

namespace viewer::batch {

enum class TaskState { waiting, running, done, failed };

struct TaskView {
    TaskState state = TaskState::waiting;
    std::optional<Result> result;
    int starts = 0; ///< attempts that were started
    Event last;     ///< of its events
};

struct BatchState {
    std::vector<TaskView> tasks; ///< of the batch
    int done = 0, running = 0, failed = 0, waiting = 0;
    int repeated = 0;                 ///< attempts that were started beyond the first of each task
    double seconds = 0;               ///< of the finished tasks together
    std::map<std::string, int> hosts; ///< finished tasks
    std::size_t damaged_lines = 0;    ///< of the journal
};

/// A task that was started, has no result, and that nobody runs is waiting: it was killed or interrupted.
BatchState state_of(Store const& store, Batch const& batch);

/// Seconds that the unfinished tasks take one after another, by the mean of the finished
/// ones of their group; 0 = unknown.
double seconds_left(Batch const& batch, BatchState const& state);

} // namespace viewer::batch
