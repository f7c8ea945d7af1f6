#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>

namespace viewer {

void add_bench(CLI::App& app, int& exit_code)
{
    CLI::App* const c = app.add_subcommand("bench", about("bench"));
    c->require_subcommand(1);
    add_bench_sweep(*c, exit_code);
    add_bench_pictures(*c, exit_code);
    add_bench_report(*c, exit_code);
    add_bench_raster(*c, exit_code);
    add_bench_rays(*c, exit_code);
    add_bench_accuracy(*c, exit_code);
    add_bench_thesis(*c, exit_code);
    add_bench_dynamic(*c, exit_code);
    add_bench_views(*c, exit_code);
    add_bench_schedules(*c, exit_code);
    for (char const* const name : {"raster", "rays", "accuracy", "thesis", "dynamic", "views", "schedules"})
        c->get_subcommand(name)->group("Measurements for developers of Lightwell");
    c->footer(R"(Examples:
  lightwell bench sweep --scene cornell --methods paths,reference --budgets 20ms,80ms --size 48x48 --reference-paths 64 --out sweep
  lightwell bench report sweep)");
}

} // namespace viewer
