#include "study/tables/export.h"

#include "study/tables/bids.h"
#include "study/tables/events.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace study {
namespace {

std::vector<Column> with_origin(std::vector<Column> const& columns)
{
    std::vector<Column> all{{"participant", "Participant"},
                            {"session", "Number of the session, from 1"},
                            {"simulated", "Whether the participant is a model observer"}};
    all.insert(all.end(), columns.begin(), columns.end());
    return all;
}

void append(Table& to, Table const& from, SessionStarted const& start, std::vector<std::string> const& more = {})
{
    if (to.columns.empty()) to.columns = with_origin(from.columns);
    for (auto const& row : from.rows) {
        std::vector<std::string> cells{cell(start.participant_id), cell(start.session), cell(start.is_simulated)};
        cells.insert(cells.end(), row.begin(), row.end());
        cells.insert(cells.end(), more.begin(), more.end());
        to.rows.push_back(std::move(cells));
    }
}

/// Labels of the chosen, first and second stimulus, for models of choices.
void append_trials(Table& to, Script const& s, std::vector<TrialRow> const& rows, SessionStarted const& start)
{
    for (TrialRow const& row : rows) {
        Table const one = events_table(s, {row}, row.step->block);
        auto const label = [&](std::size_t place) {
            std::string order = row.step->trial.order;
            std::erase(order, 'r');
            Stimulus const* const stimulus =
                place < order.size() ? stimulus_of(row.step->trial, order[place]) : nullptr;
            return stimulus ? cell(stimulus_label(s, *row.block, *stimulus)) : cell("");
        };
        auto const letter = chosen_letter(row);
        Stimulus const* const chosen = letter ? stimulus_of(row.step->trial, *letter) : nullptr;
        append(to, one, start,
               {label(0), label(1), chosen ? cell(stimulus_label(s, *row.block, *chosen)) : cell(""),
                cell(study::facts(row.block->task).name)});
    }
}

} // namespace

std::vector<NamedTable> export_tables(Script const& script, std::vector<RecordedSession> const& sessions)
{
    NamedTable trials{"trials", {}}, stimuli{"stimuli", {}}, sounds{"sounds", {}}, answers{"questionnaires", {}},
        other{"session_events", {}};
    trials.table.columns = with_origin(events_table(script, {}, 0).columns);
    std::vector<Column> const more{{"first", "Stimulus shown first, or on the left"},
                                   {"second", "Stimulus shown second"},
                                   {"chosen", "The chosen one"},
                                   {"task", "Task of the block"}};
    trials.table.columns.insert(trials.table.columns.end(), more.begin(), more.end());
    stimuli.table.columns = with_origin(stimuli_table(script, {}, 0).columns);
    stimuli.table.columns.push_back({"block", "Block of the script"});
    sounds.table.columns = with_origin(sounds_table(script, {}, 0).columns);
    sounds.table.columns.push_back({"block", "Block of the script"});
    for (RecordedSession const& session : sessions) {
        SessionStarted const& start = start_of(script, session);
        std::vector<TrialRow> const rows = trial_rows(script, session);
        append_trials(trials.table, script, rows, start);
        for (std::size_t b = 0; b < script.blocks.size(); ++b) {
            append(stimuli.table, stimuli_table(script, rows, int(b)), start, {cell(script.blocks[b].name)});
            append(sounds.table, sounds_table(script, rows, int(b)), start, {cell(script.blocks[b].name)});
        }
        append(answers.table, questionnaires_table(script, session), start);
        append(other.table, session_events_table(session), start);
    }
    std::vector<NamedTable> all{trials, stimuli};
    if (!script.sounds.empty()) all.push_back(sounds);
    all.insert(all.end(), {answers, other, {"participants", participants_table(script, sessions)}});
    return all;
}

std::vector<TextFile> export_files(Script const& script, std::vector<NamedTable> const& tables)
{
    std::vector<TextFile> files;
    std::string const stem = "data/study-" + label_of(script.id) + "_description-";
    nlohmann::ordered_json variables = nlohmann::ordered_json::array();
    std::vector<std::string> known;
    for (NamedTable const& t : tables) {
        files.push_back({stem + t.name + "_data.csv", csv_text(t.table, "NA")});
        for (Column const& c : t.table.columns) {
            if (std::find(known.begin(), known.end(), c.name) != known.end()) continue;
            known.push_back(c.name);
            nlohmann::ordered_json v{{"@type", "PropertyValue"}, {"name", c.name}, {"description", c.description}};
            if (!c.units.empty()) v["unitText"] = c.units;
            variables.push_back(std::move(v));
        }
    }
    nlohmann::ordered_json const description{
        {"@context", "https://schema.org/"},
        {"@type", "Dataset"},
        {"name", script.title.empty() ? script.id : script.title},
        {"description", "Trials, stimuli and questionnaires of the experiment " + script.id},
        {"variableMeasured", variables}};
    files.push_back({"dataset_description.json",
                     description.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"});
    files.push_back({"analysis.R", lme4_script(script, stem + "trials_data.csv")});
    files.push_back({"analysis.py", statsmodels_script(script, stem + "trials_data.csv")});
    return files;
}

} // namespace study
