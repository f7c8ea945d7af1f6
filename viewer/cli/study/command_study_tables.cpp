#include "gi/core/error.h"
#include "gi/core/file.h"
#include "study/tables/export.h"
#include "viewer/base/outputs.h"
#include "viewer/cli/commands.h"
#include "viewer/study/study_records.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct TablesOptions {
    std::string dir, script, out, sqlite;
};

int run_rebuild(TablesOptions const& o)
{
    study::Dataset const records = load_records(o.dir, o.script);
    int const files = rebuild_tables(o.dir, records);
    fmt::print("{}: {} sessions, {} files\n", o.dir, records.sessions.size(), files);
    return 0;
}

int run_export(TablesOptions const& o)
{
    if (o.out.empty() && o.sqlite.empty())
        throw gi::InputError("nothing to export to", "neither --out nor --sqlite is given", "give one of them");
    check_outputs({o.sqlite}, {o.script});
    if (!o.sqlite.empty()) study::check_may_become_sqlite(o.sqlite);
    study::Dataset const records = load_records(o.dir, o.script);
    auto const tables = study::export_tables(records.script, records.sessions);
    if (!o.out.empty()) write_files(o.out, study::export_files(records.script, tables));
    if (!o.sqlite.empty())
        gi::write_by_rename(
            o.sqlite, [&](std::filesystem::path const& temporary) { study::write_sqlite(temporary, tables); });
    for (study::NamedTable const& t : tables) fmt::print("{}: {} rows\n", t.name, t.table.rows.size());
    return 0;
}

void add_records(CLI::App& command, TablesOptions& o)
{
    command.add_option("DIR", o.dir, "folder of the records")->required();
    command.add_option("--script", o.script, "script of the experiment (default: the one in DIR/code)");
}

} // namespace

void add_study_tables(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<TablesOptions>();
    CLI::App* const rebuild =
        study.add_subcommand("rebuild", "Rebuild the tables (BIDS) of an experiment from its journals.");
    add_records(*rebuild, *o);
    rebuild->callback([o, &exit_code] { exit_code = run_rebuild(*o); });
    rebuild->footer(R"(Prepared by:
  lightwell study example rating --out rating.yaml
  lightwell study simulate rating.yaml --participants 1..2 --out records
Examples:
  lightwell study rebuild records --script rating.yaml

The script is copied to records/code, where later commands find it.)");

    CLI::App* const exported =
        study.add_subcommand("export", "Export all trials as one table with a script for mixed models; SQLite.");
    add_records(*exported, *o);
    exported->add_option("-o,--out", o->out, "folder for CSV tables (Psych-DS) and analysis.R (lme4)");
    exported->add_option("--sqlite", o->sqlite, "SQLite database to write, with the same tables");
    exported->callback([o, &exit_code] { exit_code = run_export(*o); });
    exported->footer(R"(Prepared by:
  lightwell study example rating --out rating.yaml
  lightwell study simulate rating.yaml --participants 1..2 --out rated
Examples:
  lightwell study export rated --script rating.yaml --out exported --sqlite rated.sqlite)");
}

} // namespace viewer
