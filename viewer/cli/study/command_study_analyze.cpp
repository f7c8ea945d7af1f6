#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/progress.h"
#include "study/analysis/result_tables.h"
#include "study/gaze/gaze_tables.h"
#include "study/observers/simulate.h"
#include "study/report/page.h"
#include "viewer/base/outputs.h"
#include "viewer/base/version.h"
#include "viewer/cli/commands.h"
#include "viewer/cli/study/gaze_command.h"
#include "viewer/study/study_records.h"
#include "viewer/study/study_table.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <optional>

namespace viewer {
namespace {

struct AnalyzeOptions {
    std::string dir, script, out;
    study::AnalysisSettings settings;
    bool json = false;
    TableOptions table;
    double guess = -1, lapse = -1; ///< below 0: as the task
    GazeOptions gaze;
};

/// The records of DIR, or those made from --table.
study::Dataset load(AnalyzeOptions& o)
{
    if (o.dir.empty() == o.table.files.empty())
        throw gi::InputError(o.dir.empty() ? "no records" : "DIR and --table",
                             "what is analysed is either a folder of records or a table",
                             "give DIR, or --table FILE --columns ROLES");
    if (o.guess >= 0) o.settings.guess = o.guess;
    if (o.lapse >= 0) o.settings.lapse = o.lapse;
    if (o.guess + o.lapse >= 1)
        throw gi::InputError(fmt::format("--guess {:g} and --lapse {:g}", o.guess, o.lapse),
                             "together they leave no room for a psychometric function",
                             "use rates whose sum is below 1");
    if (!o.dir.empty()) return load_records(o.dir, o.script);
    return load_table(o.table);
}

/// With a progress bar for each hierarchical model, and for each time that it is drawn.
study::Analysis analyze_with_progress(study::Dataset const& records, study::AnalysisSettings settings)
{
    std::optional<gi::ProgressBar> bar;
    std::string shown;
    double last = 0;
    settings.progress = [&](std::string const& what, double share) {
        if (!bar || what != shown || share < last) bar.emplace("analyze: " + what);
        shown = what;
        last = share;
        bar->update(share);
    };
    study::Analysis analysis = study::analyze(records, settings);
    analysis.version = version_number();
    analysis.git_hash = git_hash();
    return analysis;
}

/// Each table as CSV.
std::vector<study::TextFile> csv_files(study::Analysis const& analysis)
{
    std::vector<study::TextFile> files;
    for (study::ResultTable const& t : study::result_tables(analysis))
        files.push_back({t.name + ".csv", study::csv_text(t.table, "NA")});
    study::Table cautions;
    cautions.columns.push_back({"caution", "Warnings about the validity of the results"});
    for (std::string const& c : analysis.cautions) cautions.rows.push_back({c});
    if (!cautions.rows.empty()) files.push_back({"cautions.csv", study::csv_text(cautions, "NA")});
    files.push_back({"analysis.json", study::to_json(analysis)});
    return files;
}

int run_analyze(AnalyzeOptions& o)
{
    if (o.gaze.any()) {
        if (!o.table.files.empty())
            throw gi::InputError("--gaze with --table", "tables of trials have no samples of gaze",
                                 "give the folder of records, or files behind --gaze");
        return run_gaze(o.gaze, {o.dir, o.script, o.out, o.settings.exclude, o.json});
    }
    study::Dataset const records = load(o);
    study::Analysis const analysis = analyze_with_progress(records, o.settings);
    if (!o.out.empty()) write_files(o.out, csv_files(analysis));
    std::fputs((o.json ? study::to_json(analysis) : study::to_text(analysis)).c_str(), stdout);
    return 0;
}

std::optional<study::SimulatedTruth> truth_beside(std::filesystem::path const& dir)
{
    auto const file = study::truth_file(dir);
    if (!std::filesystem::exists(file)) return {};
    auto const bytes = gi::read_bytes(file, std::size_t(64) << 20);
    return study::read_truth({bytes.begin(), bytes.end()}, file.string());
}

int run_report(AnalyzeOptions& o)
{
    std::vector<std::string> inputs = o.table.files;
    inputs.push_back(o.script);
    check_outputs({o.out}, inputs);
    study::Dataset const records = load(o);
    study::Analysis const analysis = analyze_with_progress(records, o.settings);
    study::ReportFacts facts;
    facts.program = version_text();
    if (!o.dir.empty()) {
        facts.truth = truth_beside(o.dir);
        facts.frame_interval_ms = frame_intervals_ms(o.dir);
        auto gaze = study::gaze_of_records(o.dir, records, {}, o.settings.exclude);
        if (!gaze.recordings.empty()) {
            study::GazeAnalysis const looks = study::analyse_gaze(std::move(gaze), {});
            facts.gaze = study::gaze_tables(looks);
            study::ResultTable doubts{"gaze_cautions", "What was left out of gaze, or is doubtful", "", false, {}};
            doubts.table.columns = {study::name_column("caution", "")};
            for (std::string const& c : looks.cautions) doubts.table.rows.push_back({study::cell(c)});
            if (!looks.cautions.empty()) facts.gaze.push_back(std::move(doubts));
        }
    }
    gi::write_text(o.out, study::report_page(records.script, records.sessions, analysis, facts));
    fmt::print("{}\n", o.out);
    return 0;
}

void add_options(CLI::App& command, AnalyzeOptions& o)
{
    command.add_option("DIR", o.dir, "folder of the records");
    command.add_option("--script", o.script, "script of the experiment (default: the one in DIR/code)");
    command.add_option("--table", o.table.files,
                       "instead of DIR: trials of another program (CSV, TSV; several files)");
    command.add_option(
        "--columns", o.table.columns,
        "what its columns are: ROLE=COLUMN,... with the roles participant, run; pairs: first, second and "
        "chosen, first_chosen, chosen_from_0, or first_wins, second_wins, ties; ratings: item, value; answers: "
        "level, "
        "signal and correct or yes, or correct_count, wrong_count, yes_count, no_count, percent, trials; "
        "reaction_s, reaction_ms. participant=group+id: ids that begin anew in each group, file+id: in each file");
    command
        .add_option("--factors", o.table.factors,
                    "its columns with conditions or groups of participants: scene,age")
        ->delimiter(',');
    command.add_option("--only", o.table.only, "use only rows with COLUMN=VALUE (repeatable)");
    command
        .add_option("--missing", o.table.missing,
                    "what stands for a missing value in columns of numbers and answers: -99,999; COLUMN=VALUE: in "
                    "this one")
        ->delimiter(',');
    command.add_option(
        "--long", o.table.names_and_values,
        "the table has a row per value: NAME=VALUE, its columns with the names and values of variables");
    command.add_option("--task", o.table.task,
                       "task of its trials, if the roles do not tell: magnitude, abx, oddity, ...");
    command.add_option("--scale", o.table.scale, "scale of its levels")
        ->check(CLI::IsMember({"linear", "log2", "log10", "db"}))
        ->capture_default_str();
    command.add_option("--harder", o.table.harder, "whether lower or higher levels are harder")
        ->check(CLI::IsMember({"down", "up"}))
        ->capture_default_str();
    command.add_flag("--matrix", o.table.is_matrix,
                     "the table has an item per row and column: row chosen over column");
    command.add_option("--guess", o.guess, "fixes the guess rate of psychometric functions")
        ->check(CLI::Range(0.0, 0.99));
    command.add_option("--lapse", o.lapse, "fixes their lapse rate")->check(CLI::Range(0.0, 0.5));
    command.add_option("--exclude", o.settings.exclude, "participants to exclude: P003,P007")->delimiter(',');
    command.add_option("--replicates", o.settings.replicates, "number of bootstrap samples over observers")
        ->check(CLI::Range(100, 100000))
        ->capture_default_str();
    command.add_option("--draws", o.settings.draws, "draws of each of 4 chains of hierarchical models; 0 = none")
        ->check(CLI::Range(0, 20000))
        ->capture_default_str();
    command.add_flag("--hierarchical", o.settings.has_hierarchy,
                     "also scales of pairs with observers as random effects (Bayesian; seconds each)");
    command.add_option("--confidence", o.settings.confidence, "confidence level of intervals")
        ->check(CLI::Range(0.5, 0.999))
        ->capture_default_str();
    command.add_option("--seed", o.settings.seed, "seed of bootstraps, chains and simulated runs")
        ->capture_default_str();
}

} // namespace

void add_study_analyze(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<AnalyzeOptions>();
    CLI::App* const analyze = study.add_subcommand(
        "analyze", "Analyse the records: exclusions, scales, thresholds, tests, timing, with uncertainties.");
    add_options(*analyze, *o);
    add_gaze_options(*analyze, o->gaze);
    analyze->add_flag("--json", o->json, "print JSON");
    analyze->add_option("-o,--out", o->out, "folder for each table as CSV and the whole analysis as JSON");
    analyze->callback([o, &exit_code] { exit_code = run_analyze(*o); });
    analyze->footer(R"(Prepared by:
  lightwell study example pairs --out pairs.yaml
  lightwell study simulate pairs.yaml --participants 1..6 --out compared
  lightwell study export compared --script pairs.yaml --out tables
Examples:
  lightwell study analyze compared --script pairs.yaml --exclude P002
  lightwell study analyze --table tables/data/study-pairs_description-trials_data.csv --only analysis=counted --columns participant=participant,first=first,second=second,chosen=chosen)");

    CLI::App* const report =
        study.add_subcommand("report", "Write the same analysis as one HTML page with figures, also for print.");
    add_options(*report, *o);
    report->add_option("-o,--out", o->out, "file to write (HTML)")->required();
    report->callback([o, &exit_code] { exit_code = run_report(*o); });
    report->footer(R"(Prepared by:
  lightwell study example staircase --out staircase.yaml
  lightwell study simulate staircase.yaml --participants 1..4 --out climbed
Examples:
  lightwell study report climbed --script staircase.yaml --out report.html)");
}

} // namespace viewer
