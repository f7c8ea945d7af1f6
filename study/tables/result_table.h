#pragma once
// A table of results, for the terminal, CSV, JSON and reports.

#include "study/tables/table.h"

namespace study {

struct ResultTable {
    std::string name; ///< of files and JSON: "scores"
    std::string title, note;
    bool is_long = false; ///< too long for a terminal
    Table table;
};

} // namespace study
