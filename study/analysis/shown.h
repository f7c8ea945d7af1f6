#pragma once
// Numbers of results as people read them, in the terminal and in reports. JSON and CSV have all digits.

#include "study/tables/table.h"

namespace study {

/// The number that a cell of a table is; empty if it is a text or n/a.
std::optional<double> number_of_cell(std::string const& cell);
/// "0.00465 [0.00433, 0.00498]": with two digits of the half width of the interval, the digits that carry the error.
/// An end that the data leave open (NaN or infinite) is "open"; without both ends the value alone, as shown_number().
/// Without a value, as where it is infinite, "– [2.605, open]", or "–".
std::string shown_estimate(double value, double low, double high);
/// Four significant digits; whole digits and decimals of numbers from 1e-4 to 1e7, else an exponent; "–" if not finite.
std::string shown_number(double value);
/// Three significant digits, "<0.001" below.
std::string shown_p(double p);
/// A cell of a table by shown_number(), or by shown_p() in columns named p or p_...; texts unchanged, "–" for n/a.
std::string shown_cell(Column const& column, std::string const& cell);

struct ShownTable {
    struct Head {
        std::string name, description;
        bool is_number = false;
    };
    std::vector<Head> columns;
    std::vector<std::vector<std::string>> rows{};
};
/// A table whose estimates are joined with their intervals (Column::has_interval) by shown_estimate().
ShownTable shown_table(Table const& table);

} // namespace study
