#include "viewer/bench/bench_record.h"

#include "gi/core/error.h"
#include "viewer/base/version.h"
#include "viewer/report/table_file.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace viewer {
namespace fs = std::filesystem;

BenchTable start_table(std::string const& name, std::string const& title, std::vector<std::string> const& columns)
{
    BenchTable table;
    table.name = name;
    table.title = title;
    table.columns = columns;
    table.program = version_text();
    table.command = this_command();
    table.date = this_moment();
    table.machine = this_machine();
    return table;
}

void check_folder(std::string const& folder)
{
    auto const cannot = [&](std::string const& why, std::string const& suggestion) {
        return gi::InputError("cannot write to the folder '" + folder + "'", why, suggestion);
    };
    std::error_code error;
    fs::path const path = fs::absolute(folder, error).lexically_normal();
    if (fs::exists(path, error) && !fs::is_directory(path, error))
        throw cannot("it is a file", "choose another --out");
    fs::path there = path; // the part of the path that exists
    while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
    if (!fs::is_directory(there, error))
        throw cannot("'" + there.string() + "' is a file", "choose another --out");
    if (access(there.c_str(), W_OK) != 0)
        throw cannot("'" + there.string() + "' is read-only", "choose another --out");
}

void show(BenchTable const& table, std::string const& folder, bool json)
{
    if (json) {
        std::fputs(to_json(table).c_str(), stdout);
    } else {
        print(table);
        for (char const* extension : {".json", ".csv"})
            fmt::print("{}\n", (fs::path(folder) / (table.name + extension)).string());
    }
    std::fflush(stdout);
}

} // namespace viewer
