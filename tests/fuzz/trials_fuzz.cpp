// Any text as a table of other programs' trials, after a line with the roles of its columns (that of factors is
// "factors", and the line may be "matrix"): sessions of an experiment, or a ScriptError on one line.

#include "study/imported/trial_table.h"

#include <algorithm>
#include <cstdlib>

namespace {

/// Counts become single trials: a few rows may ask for millions, which takes long, and is all that it does.
bool has_large_numbers(std::string const& text)
{
    int digits = 0;
    for (char const c : text) {
        digits = c >= '0' && c <= '9' ? digits + 1 : 0;
        if (digits > 4) return true;
    }
    return false;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const all(reinterpret_cast<char const*>(data), size);
    std::size_t const end = std::min(all.find('\n'), size);
    try {
        study::DelimitedText const table = study::read_delimited(all.substr(std::min(end + 1, size)), "fuzz");
        for (auto const& row : table.rows)
            if (row.size() != table.columns.size()) std::abort();
        if (has_large_numbers(all)) return 0;
        study::ColumnRoles roles;
        roles.is_matrix = all.substr(0, end) == "matrix";
        if (!roles.is_matrix) roles.column = study::parse_roles(all.substr(0, end));
        if (table.column("factors") >= 0) roles.factors = {"factors"};
        study::ImportedTable const made = study::import_trials(table, roles);
        if (made.sessions.empty()) std::abort();
    } catch (gi::InputError const& e) {
        if (std::string(e.what()).find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
