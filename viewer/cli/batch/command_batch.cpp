#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/batch/from_command.h"
#include "viewer/batch/gather.h"
#include "viewer/batch/hyperqueue.h"
#include "viewer/batch/manifest.h"
#include "viewer/batch/state.h"
#include "viewer/batch/texts.h"
#include "viewer/batch/work.h"
#include "viewer/cli/batch/batch_text.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <memory>
#include <set>

namespace viewer {
namespace {

namespace fs = std::filesystem;

struct BatchOptions {
    std::string manifest, store, wanted, out, on = "local", server_dir;
    std::vector<int> workers;
    std::vector<std::string> command;
    int cores = 0, frames_per_task = 8;
    bool json = false, quiet = false, link = false, replace = false, messages = false;
};

std::vector<std::string> commands_of_tasks()
{
    std::vector<std::string> names;
    for (CommandRow const& c : commands())
        if (c.name.find(' ') == c.name.npos && c.name != "batch") names.emplace_back(c.name);
    return names;
}

/// @return exit code: 0, or 2 after telling all mistakes
int read(BatchOptions const& o, batch::Batch& out)
{
    batch::ReadManifest read =
        batch::read_manifest(gi::read_text(o.manifest, std::size_t(1) << 20), o.manifest, commands_of_tasks());
    for (gi::InputError const& e : read.mistakes.in_order())
        std::fputs(fmt::format("lightwell: {}\n", e.what()).c_str(), stderr);
    if (!read.mistakes.empty()) return 2;
    out = std::move(read.batch);
    out.program = batch::program_identity(batch::program_folder());
    batch::give_keys(out);
    return 0;
}

fs::path store_of(BatchOptions const& o)
{
    if (!o.store.empty()) return o.store;
    return (o.manifest.empty() ? fs::path("lightwell") : fs::path(o.manifest).stem()).string() + ".batch";
}

int number_of(char const* variable, int otherwise)
{
    char const* const text = std::getenv(variable);
    return text == nullptr ? otherwise : std::max(0, std::atoi(text));
}

/// @param told  failures reported before: each is reported once
void settle(batch::Store const& store, std::set<std::string>& told)
{
    for (std::string const& failure : settle_leftovers(store))
        if (told.insert(failure).second)
            std::fputs(fmt::format("lightwell: a finished task is not published yet: {}\n", failure).c_str(),
                       stderr);
}

/// Runs what is missing. Under mpirun each process takes tasks that no other has.
int run_batch(BatchOptions const& o, batch::Store const& store, std::string const& id, batch::Batch const& b)
{
    if (b.program != batch::program_identity(batch::program_folder()))
        throw gi::InputError("the batch '" + id + "' was planned by another version of the program",
                             "it was " + b.program + ", its results would differ from this one's",
                             "use that one, or call lightwell batch with the manifest again");
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    fs::path const folder = batch::program_folder();
    int const rank = number_of("OMPI_COMM_WORLD_RANK", 0),
              ranks = std::max(1, number_of("OMPI_COMM_WORLD_SIZE", 1));
    batch::Machine machine = batch::this_machine();
    batch::RunOutcome outcome;
    std::set<std::string> told;
    settle(store, told); // so that nothing is done again that need not be
    if (o.on == "hyperqueue") {
        if (ranks > 1)
            throw gi::InputError("--on hyperqueue under mpirun", "HyperQueue has workers of its own",
                                 "leave out one");
        std::vector<int> const cores =
            !o.workers.empty() ? o.workers : std::vector{o.cores > 0 ? o.cores : int(machine.cores.size())};
        outcome =
            run_on_hyperqueue(store, id, b, {folder / "lightwell-batch", o.server_dir, cores, !o.quiet}, stop);
    } else {
        if (int const here = number_of("OMPI_COMM_WORLD_LOCAL_SIZE", 1); here > 1)
            machine = part_of(machine, number_of("OMPI_COMM_WORLD_LOCAL_RANK", 0), here);
        if (o.cores > 0) set_cores(machine, o.cores);
        outcome = run_locally(store, b, {folder / "lightwell", machine, !o.quiet && rank == 0, rank, ranks}, stop);
    }
    settle(store, told); // of processes that were killed meanwhile
    if (rank == 0) print_run(store, id, b, outcome, o.json);
    return outcome.is_interrupted ? interrupted_code() : outcome.counts.failed > 0 ? 1 : 0;
}

int start(BatchOptions const& o, batch::Batch const& b)
{
    batch::Store const store = batch::Store::open_or_make(store_of(o));
    return run_batch(o, store, store.keep(b), b);
}

int run_manifest(BatchOptions const& o)
{
    if (o.manifest.empty())
        throw gi::InputError("no manifest", "lightwell batch runs the tasks that one describes",
                             "lightwell batch MANIFEST.yaml, or see lightwell batch --help");
    batch::Batch b;
    int const code = read(o, b);
    return code != 0 ? code : start(o, b);
}

int run_command(BatchOptions const& o, char const* name)
{
    std::vector<std::string> words = o.command;
    words.insert(words.begin(), name);
    batch::Batch b = words.front() == "render" ? batch::batch_of_render(words, o.frames_per_task)
                                               : batch::batch_of_bench(words);
    b.program = batch::program_identity(batch::program_folder());
    batch::give_keys(b);
    return start(o, b);
}

int run_plan(BatchOptions const& o)
{
    batch::Batch b;
    if (int const code = read(o, b); code != 0) return code;
    batch::BatchState state;
    std::error_code none;
    if (fs::exists(store_of(o) / "format", none))
        state = state_of(batch::Store::open(store_of(o)), b);
    else
        state.tasks.resize(b.tasks.size());
    print_plan(b, state, int(batch::this_machine().cores.size()), o.json);
    return 0;
}

int run_status(BatchOptions const& o)
{
    batch::Store const store = batch::Store::open(o.store);
    std::vector<std::string> ids = store.batches();
    if (!o.wanted.empty() || ids.empty()) ids = {store.find_batch(o.wanted)};
    print_states(store, ids, o.messages, o.json);
    return 0;
}

int run_resume(BatchOptions const& o)
{
    batch::Store const store = batch::Store::open(o.store);
    std::string const id = store.find_batch(o.wanted);
    return run_batch(o, store, id, store.batch(id));
}

int run_gather(BatchOptions const& o)
{
    batch::Store const store = batch::Store::open(o.store);
    batch::Batch const b = store.batch(store.find_batch(o.wanted));
    batch::Gathered const g = gather(store, b, o.out, o.link ? batch::Placing::link : batch::Placing::copy,
                                     o.replace ? batch::Existing::replace : batch::Existing::refuse);
    print_gathered(g, b, o.out, o.json);
    return g.missing > 0 ? 1 : 0;
}

void declare_store(CLI::App& c, std::shared_ptr<BatchOptions> const& o)
{
    c.add_option("STORE", o->store, "folder of the batch's results")->required();
    c.add_option("--batch", o->wanted, "name or id of a batch in it (default: the one that was started last)");
    c.add_flag("--json", o->json, "print JSON");
}

void declare_run(CLI::App& c, std::shared_ptr<BatchOptions> const& o)
{
    c.add_option("--cores", o->cores, "cores to use on this machine (default: all)")->check(CLI::Range(1, 4096));
    c.add_option("--on", o->on, "where tasks run: local (this machine, or those of mpirun) or hyperqueue")
        ->check(CLI::IsMember({"local", "hyperqueue"}))
        ->capture_default_str();
    c.add_option("--hq-server-dir", o->server_dir,
                 "folder of a server of HyperQueue that runs (default: one is started on this machine)");
    c.add_option("--hq-workers", o->workers,
                 "cores of each worker of an own server, e.g. 4,4 (default: one worker)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(1, 4096));
    c.add_flag("--quiet", o->quiet, "no progress");
}

} // namespace

void add_batch(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<BatchOptions>();
    CLI::App* const c = app.add_subcommand("batch", about("batch"));
    c->require_subcommand(0, 1);
    c->add_option("MANIFEST", o->manifest, "tasks to run (YAML, schema batch/2, docs/batch.md)");
    c->add_option("--store", o->store, "folder for results (default: MANIFEST's name with .batch)");
    c->add_option("--frames-per-task", o->frames_per_task, "of batch render")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    c->add_flag("--json", o->json, "print JSON");
    declare_run(*c, o);
    c->callback([o, c, &exit_code] {
        if (c->get_subcommands().empty()) exit_code = run_manifest(*o);
    });

    CLI::App* const example = c->add_subcommand("example", "Write an example of a manifest.");
    example->add_option("-o,--out", o->out, "file to write")->required();
    example->callback([o] {
        check_outputs({o->out}, {});
        gi::write_text(o->out, batch::kExampleManifest);
        fmt::print("{}\n", o->out);
    });

    CLI::App* const plan =
        c->add_subcommand("plan", "Print what a manifest would run, what is done, what it costs.");
    plan->add_option("MANIFEST", o->manifest, "tasks (YAML)")->required();
    plan->add_option("--store", o->store, "folder of results (default: MANIFEST's name with .batch)");
    plan->add_flag("--json", o->json, "print JSON");
    plan->callback([o, &exit_code] { exit_code = run_plan(*o); });

    CLI::App* const status = c->add_subcommand("status", "Show what is done, runs, or failed, and why.");
    declare_store(*status, o);
    status->add_flag("--messages", o->messages, "also what finished tasks wrote on stderr");
    status->callback([o, &exit_code] { exit_code = run_status(*o); });

    CLI::App* const resume = c->add_subcommand("resume", "Run what is missing, also what has failed.");
    declare_store(*resume, o);
    declare_run(*resume, o);
    resume->callback([o, &exit_code] { exit_code = run_resume(*o); });

    CLI::App* const gather = c->add_subcommand("gather", "Put the outputs where you want them, and join tables.");
    declare_store(*gather, o);
    gather->add_option("-o,--out", o->out, "folder for them: FOLDER/GROUP/NAME")->required();
    gather->add_flag("--link", o->link,
                     "hard links to the files of the store, which are read-only, where possible");
    gather->add_flag("--replace", o->replace, "replace files that have another content");
    gather->callback([o, &exit_code] { exit_code = run_gather(*o); });

    for (char const* const name : {"render", "bench"}) {
        CLI::App* const from = c->add_subcommand(
            name, std::string(name) == "render" ? "`lightwell render --frames ...` as tasks of a few frames each."
                                                : "`lightwell bench sweep|pictures ...` as a task per scene.");
        from->prefix_command();
        from->set_help_flag();
        from->callback([o, from, name, &exit_code] {
            o->command = from->remaining();
            exit_code = run_command(*o, name);
        });
    }
    add_batch_work(*c, exit_code);
    c->footer(R"(Examples:
  lightwell batch example --out example.yaml
  lightwell batch plan example.yaml
  lightwell batch example.yaml
  lightwell batch gather example.batch --out results
  lightwell batch status example.batch
  lightwell batch resume example.batch
  lightwell batch --store walk.batch render atrium --frames 0:4@24 --paths 1 --size 32x24 --out walk_%04d.exr

`mpirun -n 4 --host a,b,c,d lightwell batch example.yaml` uses four machines that share a disk, and
`lightwell batch example.yaml --on hyperqueue` those of HyperQueue.
Finished tasks are never done again: the same command, or batch resume STORE, goes on after any interruption.
Exit codes: 0 all tasks are done, 1 some failed, 2 the manifest or the call is wrong, 130 interrupted.)");
}

} // namespace viewer
