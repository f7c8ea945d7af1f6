#include "study/tables/table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace study {
namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

bool is_alphanumeric(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::string joined(Table const& table, std::vector<std::string> const& cells)
{
    if (cells.size() != table.columns.size())
        throw std::logic_error(fmt::format("{} cells for {} columns", cells.size(), table.columns.size()));
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        line += i ? "\t" : "";
        std::replace_copy_if(cells[i].begin(), cells[i].end(), std::back_inserter(line), is_control, ' ');
    }
    return line + "\n";
}

std::string quoted_for_csv(std::string const& text)
{
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string out = "\"";
    for (char const c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

} // namespace

Column name_column(std::string name, std::string description)
{
    Column c{std::move(name), std::move(description)};
    c.is_name = true;
    return c;
}

Column estimate_column(std::string name, std::string description, std::string units)
{
    Column c{std::move(name), std::move(description), std::move(units)};
    c.has_interval = true;
    return c;
}

std::string full_cell(double value)
{
    return std::isfinite(value) ? fmt::format("{:.15g}", value) : std::string(kNothing);
}

std::string cell(double value)
{
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string(kNothing);
}
std::string cell(std::optional<double> value) { return value ? cell(*value) : std::string(kNothing); }
std::string cell(int value) { return std::to_string(value); }
std::string cell(bool value) { return value ? "true" : "false"; }
std::string cell(std::optional<bool> value) { return value ? cell(*value) : std::string(kNothing); }

std::string cell(std::string_view text)
{
    if (text.empty()) return std::string(kNothing);
    std::string out(text);
    std::replace_if(
        out.begin(), out.end(), [](char c) { return is_control(c) && c != '\t' && c != '\n'; }, ' ');
    return out;
}

std::string seconds_cell(double seconds)
{
    return std::isfinite(seconds) ? fmt::format("{:.6f}", seconds) : std::string(kNothing);
}

std::string tsv_text(Table const& table)
{
    std::vector<std::string> names;
    for (Column const& c : table.columns) names.push_back(c.name);
    std::string text = joined(table, names);
    for (auto const& row : table.rows) text += joined(table, row);
    return text;
}

std::string csv_text(Table const& table, std::string_view nothing)
{
    std::string text;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        text += (c ? "," : "") + quoted_for_csv(table.columns[c].name);
    text += "\n";
    for (auto const& row : table.rows) {
        for (std::size_t c = 0; c < row.size(); ++c)
            text += (c ? "," : "") + (row[c] == kNothing ? std::string(nothing) : quoted_for_csv(row[c]));
        text += "\n";
    }
    return text;
}

std::string hed_name(std::string_view text)
{
    std::string name;
    for (char const c : text) name += is_alphanumeric(c) || c == '-' || c == '_' ? c : '_';
    return name;
}

std::string sidecar_json(Table const& table, std::vector<SidecarFact> const& facts)
{
    nlohmann::ordered_json j = nlohmann::ordered_json::object();
    for (SidecarFact const& fact : facts) {
        std::size_t const dot = fact.key.find('.');
        auto& to = dot == std::string::npos ? j[fact.key] : j[fact.key.substr(0, dot)][fact.key.substr(dot + 1)];
        if (fact.is_json)
            to = nlohmann::ordered_json::parse(fact.value);
        else
            to = fact.value;
    }
    for (Column const& c : table.columns) {
        nlohmann::ordered_json about{{"Description", c.description}};
        if (!c.units.empty()) about["Units"] = c.units;
        for (auto const& [value, meaning] : c.meanings) about["Levels"][value] = meaning;
        if (!c.hed.empty()) about["HED"] = c.hed;
        for (auto const& [value, tags] : c.hed_of) about["HED"][value] = tags;
        j[c.name] = std::move(about);
    }
    return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string label_of(std::string_view text, std::vector<std::string> const& taken)
{
    std::string label;
    std::copy_if(text.begin(), text.end(), std::back_inserter(label), is_alphanumeric);
    if (label.empty()) label = "x";
    std::string unique = label;
    for (int i = 2; std::find(taken.begin(), taken.end(), unique) != taken.end(); ++i)
        unique = label + "x" + std::to_string(i);
    return unique;
}

} // namespace study
