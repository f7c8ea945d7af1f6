#include "viewer/report/table.h"

#include "gi/core/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace viewer {
namespace {

std::string number_text(double v)
{
    // Integers that fit are shown in full, e.g. counts of paths, not as 1.638e+04.
    if (v == std::round(v) && std::abs(v) < 1e6) return fmt::format("{:.0f}", v);
    return fmt::format("{:.4g}", v);
}

/// Shows the range as +- half its width, so that more columns fit.
std::string short_text(Cell const& cell)
{
    auto const* m = std::get_if<Measured>(&cell);
    if (m == nullptr) return to_text(cell);
    double const half = m->median != 0 ? 50 * (m->max - m->min) / std::abs(m->median) : 0;
    return number_text(m->median) + (m->repeats < 2 ? "" : fmt::format(" ±{:.0f}%", half));
}

} // namespace

void BenchTable::add(std::vector<Cell> row)
{
    if (row.size() != columns.size())
        throw std::logic_error(
            fmt::format("table {}: a row of {} cells for {} columns", name, row.size(), columns.size()));
    rows.push_back(std::move(row));
}

int BenchTable::column(std::string const& column_name) const
{
    auto const at = std::find(columns.begin(), columns.end(), column_name);
    return at == columns.end() ? -1 : int(at - columns.begin());
}

Cell const& cell(BenchTable const& table, std::vector<Cell> const& row, std::string const& column_name)
{
    static Cell const kNothing;
    int const column = table.column(column_name);
    return column < 0 ? kNothing : row[std::size_t(column)];
}

double number(Cell const& cell)
{
    if (auto const* measured = std::get_if<Measured>(&cell)) return measured->median;
    auto const* value = std::get_if<double>(&cell);
    return value != nullptr ? *value : std::numeric_limits<double>::quiet_NaN();
}

std::string to_text(Cell const& cell)
{
    if (auto const* text = std::get_if<std::string>(&cell)) return *text;
    if (auto const* value = std::get_if<double>(&cell)) return number_text(*value);
    if (auto const* m = std::get_if<Measured>(&cell))
        return number_text(m->median) +
               (m->repeats < 2 || m->min == m->max
                    ? ""
                    : fmt::format(" ({} to {})", number_text(m->min), number_text(m->max)));
    return "";
}

bool holds_text(BenchTable const& table, std::size_t column)
{
    return std::any_of(table.rows.begin(), table.rows.end(),
                       [&](auto const& row) { return std::holds_alternative<std::string>(row[column]); });
}

bool names_file(std::string const& column_name) { return column_name.ends_with("_file"); }

std::string to_text(BenchTable const& table)
{
    std::vector<std::vector<std::string>> lines(table.rows.size() + 1);
    std::vector<bool> right;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        if (names_file(table.columns[c])) continue;
        right.push_back(!holds_text(table, c));
        lines[0].push_back(table.columns[c]);
        for (std::size_t r = 0; r < table.rows.size(); ++r) lines[r + 1].push_back(short_text(table.rows[r][c]));
    }
    return gi::aligned(lines, right);
}

void print(BenchTable const& table) { std::fputs(to_text(table).c_str(), stdout); }

} // namespace viewer
