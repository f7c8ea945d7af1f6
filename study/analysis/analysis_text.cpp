#include "gi/core/text.h"
#include "study/analysis/result_tables.h"
#include "study/analysis/shown.h"
#include "study/analysis/table_json.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace study {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(Column const& column, std::string const& text)
{
    if (text == kNothing) return nullptr;
    if (column.is_name) return text;
    if (text == "true" || text == "false") return text == "true";
    if (auto const v = number_of_cell(text)) return *v;
    return text;
}

} // namespace

std::string to_text(Analysis const& a)
{
    std::string out = fmt::format("{}: {} participants of {} planned, {} sessions, {} complete\n", a.experiment,
                                  a.participants, a.planned, a.sessions, a.complete);
    for (std::string const& c : a.cautions) out += "caution: " + c + "\n";
    return out + tables_text(result_tables(a));
}

std::string tables_text(std::span<ResultTable const> tables)
{
    std::string out, left_out;
    for (ResultTable const& r : tables) {
        if (r.is_long) {
            left_out += fmt::format("{}{} ({})", left_out.empty() ? "" : ", ", r.name, r.table.rows.size());
            continue;
        }
        out += "\n" + r.title + "\n";
        if (!r.note.empty()) out += "  " + r.note + "\n";
        ShownTable const shown = shown_table(r.table);
        // The indent is the first column.
        std::vector<std::vector<std::string>> rows(1 + shown.rows.size(), std::vector<std::string>{""});
        std::vector<bool> right{false};
        for (ShownTable::Head const& head : shown.columns) {
            right.push_back(head.is_number);
            rows[0].push_back(head.name);
        }
        for (std::size_t k = 0; k < shown.rows.size(); ++k)
            rows[k + 1].insert(rows[k + 1].end(), shown.rows[k].begin(), shown.rows[k].end());
        out += gi::aligned(rows, right);
    }
    if (!left_out.empty()) out += "\nrows only in --json and --out: " + left_out + "\n";
    return out;
}

void add_tables(Json& to, std::span<ResultTable const> tables)
{
    for (ResultTable const& r : tables) {
        Json rows = Json::array();
        for (auto const& row : r.table.rows) {
            Json object = Json::object();
            for (std::size_t c = 0; c < row.size(); ++c)
                object[r.table.columns[c].name] = json_of(r.table.columns[c], row[c]);
            rows.push_back(std::move(object));
        }
        to["tables"][r.name] = std::move(rows);
        for (Column const& c : r.table.columns) to["columns"][r.name][c.name] = c.description;
    }
}

std::string to_json(Analysis const& a)
{
    Json inputs = Json::array();
    for (InputFile const& f : a.inputs) inputs.push_back({{"file", f.file}, {"sha256", f.sha256}});
    Json j{{"version", a.version},
           {"git", a.git_hash},
           {"inputs", std::move(inputs)},
           {"experiment", a.experiment},
           {"title", a.title},
           {"participants", a.participants},
           {"participants_planned", a.planned},
           {"sessions", a.sessions},
           {"sessions_complete", a.complete},
           {"sessions_simulated", a.simulated},
           {"sessions_with_another_plan", a.other_plans},
           {"sessions_with_an_assumed_plan", a.assumed_plans},
           {"settings",
            {{"excluded", a.settings.exclude},
             {"replicates", a.settings.replicates},
             {"permutations", a.settings.permutations},
             {"draws", a.settings.draws},
             {"hierarchical", a.settings.has_hierarchy},
             {"guess", a.settings.guess ? Json(*a.settings.guess) : Json()},
             {"lapse", a.settings.lapse ? Json(*a.settings.lapse) : Json()},
             {"confidence", a.settings.confidence},
             {"seed", a.settings.seed}}},
           {"cautions", a.cautions}};
    add_tables(j, result_tables(a));
    for (BlockResult const& b : a.blocks) {
        Json block = Json::object();
        for (ScaleResult const& s : b.scales)
            if (!s.wins.empty()) {
                Json names = Json::array();
                for (ScaledItem const& i : s.items) names.push_back(i.name);
                block["wins"][s.group] = {{"items", names}, {"row_over_column", s.wins}};
            }
        for (ThresholdRun const& r : b.runs) {
            if (!r.has_order) continue;
            block["tracks"].push_back({{"participant", r.participant},
                                       {"procedure", r.procedure},
                                       {"cell", r.cell},
                                       {"run", r.run},
                                       {"levels", r.levels},
                                       {"correct", r.correct},
                                       {"reversals", r.reversals}});
        }
        if (!block.empty()) j["blocks"][b.name] = std::move(block);
    }
    return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace study
