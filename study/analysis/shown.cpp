#include "study/analysis/shown.h"

#include "gi/core/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// Beyond them numbers have an exponent.
constexpr double kLeastPlain = 1e-4, kMostPlain = 1e12;
constexpr int kMostDigits = 15; ///< that double precision has

int power_of(double v) { return v == 0 ? 0 : int(std::floor(std::log10(std::abs(v)))); }

/// With `decimals` after the point, or, if it is below 0, whole numbers; no "-0.00".
std::string with_decimals(double v, int decimals, bool is_plain)
{
    if (!std::isfinite(v)) return "open";
    if (!is_plain) {
        int const digits = power_of(v) + decimals; // behind the point, before the exponent
        return v == 0 || digits < 0 ? "0" : fmt::format("{:.{}e}", v, std::min(digits, kMostDigits - 1));
    }
    std::string text = fmt::format("{:.{}f}", v, std::max(0, decimals));
    if (text.find_first_of("123456789") == std::string::npos && text.front() == '-') text.erase(0, 1);
    return text;
}

bool is_number_column(Table const& t, std::size_t c)
{
    return !t.columns[c].is_name && std::all_of(t.rows.begin(), t.rows.end(), [&](auto const& row) {
        return row[c] == kNothing || number_of_cell(row[c]);
    });
}

} // namespace

std::optional<double> number_of_cell(std::string const& cell)
{
    if (cell.find_first_not_of("0123456789+-.e") != std::string::npos) return {};
    return gi::parse_finite(cell);
}

std::string shown_estimate(double value, double low, double high)
{
    bool const has_low = std::isfinite(low), has_high = std::isfinite(high);
    if (!has_low && !has_high) return shown_number(value);
    if (!std::isfinite(value))
        return fmt::format("– [{}, {}]", has_low ? shown_number(low) : "open",
                           has_high ? shown_number(high) : "open");
    double half = has_low && has_high ? (high - low) / 2 : std::abs(value - (has_low ? low : high));
    if (!(half > 0)) half = std::abs(value - low); // of an interval without width, beside the value
    double largest = std::abs(value);
    if (has_low) largest = std::fmax(largest, std::abs(low));
    if (has_high) largest = std::fmax(largest, std::abs(high));
    if (largest == 0) return "0 [0, 0]";
    bool const is_plain = largest >= kLeastPlain && largest < kMostPlain;
    constexpr int kWithoutError = 6;
    int const most = kMostDigits - 1 - power_of(largest);
    int const decimals = half > 0 ? std::min(1 - power_of(half), most) : kWithoutError - 1 - power_of(largest);
    return fmt::format("{} [{}, {}]", with_decimals(value, decimals, is_plain),
                       with_decimals(low, decimals, is_plain), with_decimals(high, decimals, is_plain));
}

std::string shown_number(double v)
{
    if (!std::isfinite(v)) return "–";
    double const size = std::abs(v);
    constexpr double kMostWhole = 1e7;
    if (size < kMostWhole && (v == std::floor(v) || size >= 1000)) return with_decimals(v, 0, true);
    // Of large numbers the digits that differ may be the last ones.
    return size >= kMostWhole ? fmt::format("{:.9g}", v) : fmt::format("{:.4g}", v);
}

std::string shown_p(double p)
{
    if (!std::isfinite(p)) return "–";
    return p < 0.001 ? "<0.001" : fmt::format("{:.3g}", p);
}

std::string shown_cell(Column const& column, std::string const& text)
{
    if (text == kNothing) return "–";
    auto const v = number_of_cell(text);
    if (!v || column.is_name) return text;
    bool const is_p = column.name == "p" || column.name.starts_with("p_");
    return is_p ? shown_p(*v) : shown_number(*v);
}

ShownTable shown_table(Table const& t)
{
    ShownTable out;
    out.rows.resize(t.rows.size());
    for (std::size_t c = 0; c < t.columns.size(); ++c) {
        Column const& column = t.columns[c];
        bool const is_joined = column.has_interval && is_number_column(t, c);
        out.columns.push_back(
            {column.name + (is_joined ? " [low, high]" : ""), column.description, is_number_column(t, c)});
        for (std::size_t k = 0; k < t.rows.size(); ++k) {
            auto const& row = t.rows[k];
            auto const at = [&](std::size_t i) { return number_of_cell(row[c + i]).value_or(std::nan("")); };
            out.rows[k].push_back(is_joined ? shown_estimate(at(0), at(1), at(2)) : shown_cell(column, row[c]));
        }
        if (is_joined) c += 2;
    }
    return out;
}

} // namespace study
