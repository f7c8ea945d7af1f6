#pragma once
// Runs one task and publishes its outputs.

#include "gi/core/progress.h"
#include "viewer/batch/store.h"

namespace viewer::batch {

enum class WorkEnd {
    done,
    was_done,  ///< before, or another process has done it meanwhile
    passed_on, ///< another process publishes its outputs
    taken,     ///< another process runs it
    failed,    ///< the journal says why
    interrupted
};

enum class IfTaken { wait, leave };

/// Whether this process publishes the outputs, or a copy of it that was made before.
enum class Publish { here, elsewhere };

struct WorkSettings {
    std::filesystem::path program; ///< the launcher, lightwell
    IfTaken if_taken = IfTaken::wait;
    /// Called when a kill of all processes no longer costs the task, before its outputs are published:
    /// the next one may start.
    std::function<Publish()> prepared;
};

/// Claims the task, runs it in a folder of its own, in which its inputs are linked, and again after a failure that
/// may pass, as often as the task says. Exit code 2 (wrong input) and missing outputs do not pass.
/// @param batch of the task @throws InputError the store cannot be used
WorkEnd work_on(Store const& store, Batch const& batch, Task const& task, WorkSettings const& settings,
                gi::StopRequest const& stop);

/// Exit codes of processes that work on a task.
enum WorkCode { kWorkDone = 0, kWorkFailed = 1, kWorkTaken = 3, kWorkInterrupted = 130 };
int exit_code_of(WorkEnd end);

/// Workers that may be killed with one task before it counts as failed: it may be what kills them.
inline constexpr int kMostLost = 10;

/// Publishes what killed processes had prepared, and removes the folders of tasks that are done.
/// @return why results could not be published; they are left for the next time
std::vector<std::string> settle_leftovers(Store const& store);

} // namespace viewer::batch
