#pragma once
// Runs the tasks of a batch by HyperQueue (it4innovations.github.io/hyperqueue), through its Python package: one
// job with a task of HyperQueue per task of the batch, each `lightwell batch work`, which claims, runs and
// publishes it as on one machine. So all that HyperQueue knows may be lost: the store says what is finished.

#include "viewer/batch/local_runner.h"

namespace viewer::batch {

struct HyperQueueSettings {
    std::filesystem::path worker; ///< the program that has the command `batch work`, on all machines
    std::string server_dir;       ///< of a server that runs; empty = start one here, with these workers
    std::vector<int> worker_cores;
    bool shows_progress = true;
};

/// If a server started by this program ends early, it is started again and gets the missing tasks.
/// @throws InputError Python has no package hyperqueue, or the server cannot be reached
RunOutcome run_on_hyperqueue(Store const& store, std::string const& id, Batch const& batch,
                             HyperQueueSettings const& settings, gi::StopRequest const& stop);

/// The Python interpreter whose packages are used: LIGHTWELL_PYTHON, or build/python
/// beside the program, or python3.
std::string python_program();

} // namespace viewer::batch
