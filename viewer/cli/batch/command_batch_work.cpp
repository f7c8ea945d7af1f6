#include "gi/core/error.h"
#include "viewer/base/interrupt.h"
#include "viewer/batch/work.h"
#include "viewer/batch/worker_process.h"
#include "viewer/cli/batch/batch_text.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <sys/prctl.h>
#include <unistd.h>

namespace viewer {
namespace {

struct WorkOptions {
    std::string store, id;
    std::size_t index = 0;
};

/// Goes on as another process, so that who waits for this one can start the next task. The claim goes with it.
void go_on_aside()
{
    pid_t const child = fork();
    if (child > 0) _exit(batch::kWorkDone);
    if (child == 0) setsid(); // where it cannot fork, it publishes as it is
}

int run_work(WorkOptions const& o)
{
    prctl(PR_SET_NAME, batch::kWorkerName);
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    batch::Store const store = batch::Store::open(o.store);
    batch::Batch const b = store.batch_of_task(o.id, o.index);
    std::filesystem::path const folder = batch::program_folder();
    if (b.program != batch::program_identity(folder))
        throw gi::InputError("the program of this machine is another version than the batch was planned by",
                             "here it is " + batch::program_identity(folder) + ", there " + b.program,
                             "install the same one on all machines");
    batch::WorkSettings const settings{folder / "lightwell", batch::IfTaken::wait, go_on_aside};
    return batch::exit_code_of(work_on(store, b, b.tasks.front(), settings, stop));
}

} // namespace

void add_batch_work(CLI::App& batch_command, int& exit_code)
{
    auto const o = std::make_shared<WorkOptions>();
    CLI::App* const c = batch_command.add_subcommand("work", "Run one task and publish its outputs.");
    c->group(""); // called by runners, not by people
    c->add_option("STORE", o->store)->required();
    c->add_option("BATCH", o->id)->required();
    c->add_option("INDEX", o->index)->required();
    c->callback([o, &exit_code] { exit_code = run_work(*o); });
}

} // namespace viewer
