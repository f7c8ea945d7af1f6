#include "viewer/report/table_file.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace viewer {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kSchema = 1; // incremented if a key changes its meaning or is removed

Json to_json(double v) { return std::isfinite(v) ? Json(v) : Json(); }

Json to_json(Cell const& cell)
{
    if (auto const* text = std::get_if<std::string>(&cell)) return *text;
    if (auto const* m = std::get_if<Measured>(&cell))
        return {{"median", to_json(m->median)},
                {"min", to_json(m->min)},
                {"max", to_json(m->max)},
                {"repeats", m->repeats}};
    return to_json(number(cell));
}

int to_count(Json const& json)
{
    double const value = json.get<double>();
    if (!(value >= 0 && value <= 1e9)) throw std::runtime_error("a count is out of range");
    return int(value);
}

double to_number(Json const& json) { return json.is_null() ? std::nan("") : json.get<double>(); }

Cell to_cell(Json const& json)
{
    if (json.is_null()) return {};
    if (json.is_string()) return json.get<std::string>();
    if (json.is_object())
        return Measured{to_number(json.at("median")), to_number(json.at("min")), to_number(json.at("max")),
                        to_count(json.at("repeats"))};
    return json.get<double>();
}

BenchTable to_table(Json const& json)
{
    BenchTable t;
    t.name = json.at("name");
    t.title = json.at("title");
    t.program = json.at("program");
    t.command = json.at("command");
    t.date = json.at("date");
    Json const& machine = json.at("machine");
    t.machine = {machine.at("cpu"), to_count(machine.at("cores")), machine.at("memory_gib")};
    for (auto const& [what, value] : json.at("facts").items())
        t.facts.emplace_back(what, value.get<std::string>());
    t.columns = json.at("columns").get<std::vector<std::string>>();
    for (Json const& row : json.at("rows")) {
        std::vector<Cell> cells;
        for (Json const& cell : row) cells.push_back(to_cell(cell));
        t.add(std::move(cells));
    }
    return t;
}

std::string csv_quoted(std::string const& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (char const c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string csv_number(double v) { return std::isfinite(v) ? fmt::format("{}", v) : ""; }

} // namespace

std::string to_json(BenchTable const& t)
{
    Json j;
    j["lightwell_table"] = kSchema;
    j["name"] = t.name;
    j["title"] = t.title;
    j["program"] = t.program;
    j["command"] = t.command;
    j["date"] = t.date;
    j["machine"] = {{"cpu", t.machine.cpu}, {"cores", t.machine.cores}, {"memory_gib", t.machine.memory_gib}};
    j["facts"] = Json::object();
    for (auto const& [what, value] : t.facts) j["facts"][what] = value;
    j["columns"] = t.columns;
    auto const dump = [](Json const& json, int indent) {
        return json.dump(indent, ' ', false, Json::error_handler_t::replace);
    };
    std::string text = dump(j, 1);
    text.resize(text.size() - 2); // reopened to write each row on its own line
    text += ",\n \"rows\": [";
    for (std::size_t r = 0; r < t.rows.size(); ++r) {
        Json cells = Json::array();
        for (Cell const& cell : t.rows[r]) cells.push_back(to_json(cell));
        text += (r > 0 ? ",\n  " : "\n  ") + dump(cells, -1);
    }
    return text + "\n ]\n}\n";
}

std::string to_csv(BenchTable const& t)
{
    std::vector<std::string> lines(t.rows.size() + 1);
    auto const append = [&](std::size_t line, std::string const& text, bool first) {
        lines[line] += (first ? "" : ",") + text;
    };
    for (std::size_t c = 0; c < t.columns.size(); ++c) {
        bool const has_spread = std::any_of(t.rows.begin(), t.rows.end(), [&](auto const& row) {
            return std::holds_alternative<Measured>(row[c]);
        });
        append(0, csv_quoted(t.columns[c]), c == 0);
        if (has_spread)
            for (char const* suffix : {"_min", "_max", "_repeats"})
                append(0, csv_quoted(t.columns[c] + suffix), false);
        for (std::size_t r = 0; r < t.rows.size(); ++r) {
            Cell const& cell = t.rows[r][c];
            auto const* text = std::get_if<std::string>(&cell);
            append(r + 1, text != nullptr ? csv_quoted(*text) : csv_number(number(cell)), c == 0);
            auto const* m = std::get_if<Measured>(&cell);
            if (has_spread)
                append(r + 1,
                       m == nullptr ? ",,"
                                    : fmt::format("{},{},{}", csv_number(m->min), csv_number(m->max), m->repeats),
                       false);
        }
    }
    std::string all;
    for (std::string const& line : lines) all += line + "\r\n";
    return all;
}

void write(BenchTable const& table, fs::path const& folder)
{
    gi::write_text(folder / (table.name + ".json"), to_json(table));
    gi::write_text(folder / (table.name + ".csv"), to_csv(table));
}

BenchTable parse_table(std::string const& json, std::string const& name)
{
    auto const bad = [&](std::string const& why) {
        return gi::InputError("'" + name + "' is no table of lightwell bench", why,
                              "delete it, or create it again with lightwell bench");
    };
    try {
        Json const parsed = Json::parse(json);
        if (!parsed.is_object() || !parsed.contains("lightwell_table")) throw bad("it has no \"lightwell_table\"");
        if (parsed["lightwell_table"] != kSchema)
            throw bad(fmt::format("only version {} of its format is known", kSchema));
        return to_table(parsed);
    } catch (gi::InputError const&) {
        throw;
    } catch (std::exception const& e) { // from the parser, on a wrong type, or on a row with too few cells
        throw bad(e.what());
    }
}

} // namespace viewer
