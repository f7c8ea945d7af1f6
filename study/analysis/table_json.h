#pragma once
// Tables of results as JSON: numbers as numbers, null = missing.

#include "study/tables/result_table.h"

#include <nlohmann/json.hpp>
#include <span>

namespace study {

/// Adds `tables`, by name a list of rows, and `columns`, by table and column what it is.
void add_tables(nlohmann::ordered_json& to, std::span<ResultTable const> tables);

} // namespace study
