#include "gi/base/file.h"
#include "viewer/bench/page.h"
#include "viewer/bench/table_file.h"
#include "viewer/commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

int run(std::string const& folder)
{
    std::vector<BenchTable> const tables = read_tables(folder);
    std::filesystem::path const file = std::filesystem::path(folder) / "report.html";
    gi::write_text(file, make_page(tables, folder));
    fmt::print("{}\n", file.string());
    std::fflush(stdout);
    return 0;
}

} // namespace

void add_bench_report(CLI::App& bench, int& exit_code)
{
    auto const folder = std::make_shared<std::string>();
    CLI::App* const c = bench.add_subcommand("report", "One page, DIR/report.html, of all tables in a folder.");
    c->add_option("DIR", *folder, "where bench commands have put their tables")->required();
    c->footer(R"(Examples:
  lightwell bench sweep --scene cornell --budgets 20ms --repeats 1 --size 32x32 --reference-paths 16 --out sweep
  lightwell bench report sweep)");
    c->callback([folder, &exit_code] { exit_code = run(*folder); });
}

} // namespace viewer
