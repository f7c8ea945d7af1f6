#include "gi/core/error.h"
#include "viewer/base/interrupt.h"
#include "viewer/batch/work.h"
#include "viewer/batch/worker_process.h"
#include "viewer/cli/batch/batch_text.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <sys/prctl.h>
#include <unistd.h>

namespace viewer {
namespace {

struct WorkOptions {
    std::string store, id;
    std::vector<std::size_t> indices;
};

/// Runs one task after the other. A copy of this process publishes the outputs of each beside the next one;
/// the claim goes with it.
int run_work(WorkOptions const& o)
{
    prctl(PR_SET_NAME, batch::kWorkerName);
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    batch::Store const store = batch::Store::open(o.store);
    std::filesystem::path const folder = batch::program_folder();
    std::string const program = batch::program_identity(folder);
    bool is_copy = false;
    batch::WorkSettings const settings{folder / "lightwell", batch::IfTaken::wait, [&] {
                                           pid_t const child = fork();
                                           if (child > 0) return batch::Publish::elsewhere;
                                           if (child == 0) setsid();
                                           is_copy = child == 0; // where it cannot fork, it publishes as it is
                                           return batch::Publish::here;
                                       }};
    int result = batch::kWorkDone;
    for (std::size_t const index : o.indices) {
        batch::Batch const b = store.batch_of_task(o.id, index);
        if (b.program != program)
            throw gi::InputError("the program of this machine is another version than the batch was planned by",
                                 "here it is " + program + ", there " + b.program,
                                 "install the same one on all machines");
        int code = batch::kWorkFailed;
        try {
            code = batch::exit_code_of(work_on(store, b, b.tasks.front(), settings, stop));
        } catch (gi::InputError const& e) { // the next tasks may be luckier
            std::cerr << "lightwell: " << e.what() << std::endl;
        }
        if (code != batch::kWorkDone) result = code;
        if (is_copy || code == batch::kWorkInterrupted) break;
    }
    return result;
}

} // namespace

void add_batch_work(CLI::App& batch_command, int& exit_code)
{
    auto const o = std::make_shared<WorkOptions>();
    CLI::App* const c =
        batch_command.add_subcommand("work", "Run tasks one after the other and publish their outputs.");
    c->group(""); // called by runners, not by people
    c->add_option("STORE", o->store)->required();
    c->add_option("BATCH", o->id)->required();
    c->add_option("INDEX", o->indices)->required();
    c->callback([o, &exit_code] { exit_code = run_work(*o); });
}

} // namespace viewer
