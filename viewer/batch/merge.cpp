#include "viewer/batch/merge.h"

#include "gi/core/error.h"
#include "gi/core/text.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace viewer::batch {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(std::string const& value, char separator)
{
    if (value.find_first_of(std::string("\"\n\r") + separator) == value.npos) return value;
    std::string quoted = "\"";
    for (char const c : value) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

/// Removes and returns the next row with its line end; line ends within quotes belong to it.
std::string_view take_row(std::string_view& text)
{
    bool in_quotes = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '"') in_quotes = !in_quotes;
        if (text[i] != '\n' || in_quotes) continue;
        std::string_view const row = text.substr(0, i + 1);
        text.remove_prefix(i + 1);
        return row;
    }
    return std::exchange(text, {});
}

std::string_view without_line_end(std::string_view row)
{
    while (row.ends_with('\n') || row.ends_with('\r')) row.remove_suffix(1);
    return row;
}

gi::InputError cannot_merge(Task const& task, std::string const& output, std::string const& why)
{
    return {"'" + output + "' of " + title_of(task) + " cannot be merged", why,
            "leave merge out of the manifest; all outputs are gathered as they are"};
}

} // namespace

MergedTable::MergedTable(std::string const& file) : ending_(std::filesystem::path(file).extension().string()) {}

bool MergedTable::takes(std::string const& output) const
{
    std::string const ending = std::filesystem::path(output).extension().string();
    return ending == ending_ || (ending_ == ".jsonl" && ending == ".json");
}

void MergedTable::add(Task const& task, std::string const& output, std::string const& text)
{
    if (ending_ == ".jsonl")
        add_objects(task, output, text);
    else
        add_rows(task, output, text);
}

void MergedTable::add_rows(Task const& task, std::string const& output, std::string_view text)
{
    char const separator = ending_ == ".tsv" ? '\t' : ',';
    std::string names, values;
    for (auto const& [name, value] : task.parameters) {
        names += cell(name, separator) + separator;
        values += cell(value, separator) + separator;
    }
    std::string const columns = names + std::string(without_line_end(take_row(text)));
    if (columns_.empty()) {
        columns_ = columns;
        text_ = columns + "\n";
    }
    if (columns != columns_)
        throw cannot_merge(task, output,
                           "its columns are '" + gi::shortened(columns, 200) + "', those of the first table '" +
                               gi::shortened(columns_, 200) + "'");
    while (!text.empty())
        if (std::string_view const row = without_line_end(take_row(text)); !row.empty())
            text_ += values + std::string(row) + "\n";
}

void MergedTable::add_objects(Task const& task, std::string const& output, std::string_view text)
{
    std::vector<Json> objects;
    if (Json whole = Json::parse(text, nullptr, false); whole.is_object()) {
        objects.push_back(std::move(whole));
    } else {
        for (std::string_view line; !text.empty();) {
            line = gi::trimmed(gi::take_until(text, '\n'));
            if (!line.empty()) objects.push_back(Json::parse(line, nullptr, false));
        }
    }
    for (Json const& object : objects) {
        if (!object.is_object()) throw cannot_merge(task, output, "it is no JSON object, nor lines of them");
        Json row = Json::object();
        for (auto const& [name, value] : task.parameters) row[name] = value;
        for (auto const& [name, value] : object.items()) row[row.contains(name) ? "result_" + name : name] = value;
        text_ += row.dump() + "\n";
    }
}

} // namespace viewer::batch
