#include "viewer/study/study_table.h"

#include "gi/core/file.h"
#include "gi/core/sha256.h"

#include <fmt/format.h>

namespace viewer {
namespace {

study::Scale scale_of(std::string const& name)
{
    if (name == "log2") return study::Scale::log2;
    if (name == "log10") return study::Scale::log10;
    return name == "db" ? study::Scale::db : study::Scale::linear;
}

study::Task task_of(std::string const& name)
{
    std::string known;
    for (study::Task const t : study::kTasks) {
        std::string_view const own = study::facts(t).name;
        if (name == own) return t;
        known += (known.empty() ? "" : ", ") + std::string(own);
    }
    throw gi::InputError(fmt::format("--task '{}'", name), "there is no such task", "there are: " + known);
}

std::pair<std::string, std::string> halves(std::string const& option, std::string const& text,
                                           std::string const& suggestion)
{
    auto const equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw gi::InputError(fmt::format("{} '{}'", option, text), "it has no name before an equals sign",
                             suggestion);
    return {text.substr(0, equals), text.substr(equals + 1)};
}

} // namespace

study::Dataset load_table(TableOptions const& o)
{
    if (o.columns.empty() && !o.is_matrix)
        throw gi::InputError("--table without --columns", "the meaning of its columns is unknown",
                             "name them: --columns participant=observer,first=a,second=b,chosen=choice");
    study::ColumnRoles roles;
    roles.column = study::parse_roles(o.columns);
    roles.factors = o.factors;
    for (std::string const& text : o.only) roles.only.push_back(halves("--only", text, "for example phase=main"));
    for (std::string const& text : o.missing)
        if (text.ends_with('='))
            throw gi::InputError(fmt::format("--missing '{}'", text), "empty cells are missing anyway",
                                 "for example age=-99");
    for (std::string const& text : o.missing)
        roles.missing.push_back(text.find('=') == std::string::npos
                                    ? std::pair(std::string(), text)
                                    : halves("--missing", text, "for example age=-99"));
    if (!o.task.empty()) roles.task = task_of(o.task);
    roles.scale = scale_of(o.scale);
    roles.harder_up = o.harder == "up";
    roles.is_matrix = o.is_matrix;
    std::vector<study::DelimitedText> tables;
    std::vector<study::InputFile> inputs;
    for (std::string const& file : o.files) {
        auto const bytes = gi::read_bytes(file, std::size_t(1) << 30);
        std::string const text(bytes.begin(), bytes.end());
        inputs.push_back({file, gi::sha256(text)});
        tables.push_back(study::read_delimited(text, file));
    }
    study::DelimitedText all = study::joined(tables);
    if (!o.names_and_values.empty()) {
        auto const [names, values] = halves("--long", o.names_and_values, "for example name=value");
        all = study::to_wide(all, names, values);
    }
    auto table = study::import_trials(all, roles);
    for (std::string const& note : table.notes) fmt::print(stderr, "{}: {}\n", all.file, note);
    return {std::move(table.script), {}, std::move(table.sessions), std::move(table.notes), std::move(inputs)};
}

} // namespace viewer
