#pragma once
// Runs the tasks of a batch on this machine, each by a process of its own (worker_process.h) that publishes the
// task's outputs by itself: if this runner is killed, the tasks that run are finished nevertheless.

#include "viewer/batch/machine.h"
#include "viewer/batch/progress_view.h"
#include "viewer/batch/store.h"

namespace viewer::batch {

struct LocalSettings {
    std::filesystem::path program; ///< the launcher, lightwell
    Machine machine;
    bool shows_progress = true;
    int rank = 0, ranks = 1; ///< of processes under mpirun that run the same batch: each begins elsewhere in it
};

struct RunOutcome {
    Counts counts;            ///< at the end
    std::size_t was_done = 0; ///< before it began
    int lost_workers = 0;     ///< processes that were killed, whose task was restarted
    bool is_interrupted = false;
};

/// Tasks start in the order of the batch as soon as the machine has what they need; those that other processes run
/// are waited for. After a stop request all tasks that run are ended, what is finished is kept.
/// @throws InputError a task needs more than the machine has
RunOutcome run_locally(Store const& store, Batch const& batch, LocalSettings const& settings,
                       gi::StopRequest const& stop);

} // namespace viewer::batch
