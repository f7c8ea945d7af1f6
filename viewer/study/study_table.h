#pragma once
// Tables of other programs, as commands read them.

#include "study/imported/trial_table.h"
#include "study/tables/dataset.h"

#include <string>
#include <vector>

namespace viewer {

struct TableOptions {
    std::vector<std::string> files; ///< their rows, one after another
    std::string columns, task, scale = "linear", harder = "down";
    std::string names_and_values;           ///< "name=value" of a long table; empty = one row per trial
    std::vector<std::string> factors, only; ///< only: "column=value"
    std::vector<std::string> missing;       ///< "value", or "column=value"
    bool is_matrix = false;
};

/// Reads the tables as a data set, whose remarks it prints on stderr, too. Throws InputError with file:line:column.
study::Dataset load_table(TableOptions const& options);

} // namespace viewer
