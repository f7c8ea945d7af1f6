#pragma once
// What the subcommands of `lightwell study` have in common, and how each is added: one line in add_study.

#include "study/design/script.h"
#include "study/run/session.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace viewer {

struct LoadedScript {
    study::Script script;
    std::string text;             ///< the whole file
    std::filesystem::path folder; ///< in which it lies, with its Markdown files
};
/// Throws ScriptError or InputError where the script or a Markdown file that it names cannot be read.
LoadedScript load_script(std::string const& file);
/// "3", "1..24" or "1,4,7..9"; empty = all. Rising, each once. Throws InputError where it names others than 1 to
/// count.
std::vector<int> parse_participants(std::string const& text, int count);

/// The tables of a data set made anew from its journals, and the script kept beside them, after a session. Where
/// that cannot be (records of another script), says so on stderr: the journals are the truth, and study rebuild
/// goes on.
void keep_tables(std::filesystem::path const& dir, std::string const& script_file);
/// What a session came to, as JSON and for people.
nlohmann::ordered_json session_json(std::string const& id, study::SessionOutcome const& outcome);
void print_session(std::string const& id, study::SessionOutcome const& outcome);

void print_doubts(std::vector<std::string> const& doubts); ///< on stderr, a line each

void add_study_check(CLI::App& study, int& exit_code);
void add_study_run(CLI::App& study, int& exit_code);
void add_study_control(CLI::App& study, int& exit_code);
void add_study_prepare(CLI::App& study, int& exit_code);
void add_study_simulate(CLI::App& study, int& exit_code);
void add_study_tables(CLI::App& study, int& exit_code);  ///< rebuild, export
void add_study_analyze(CLI::App& study, int& exit_code); ///< analyze, report

} // namespace viewer
