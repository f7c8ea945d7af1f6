#pragma once
// Tables as text: columns with descriptions, rows of cells that are written unchanged. Numbers are in the C
// locale, independent of the machine's; missing values are "n/a", as BIDS requires.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace study {

struct TextFile {
    std::string path; ///< relative to a folder of the caller, with '/'
    std::string text;
};

struct Column {
    std::string name, description;
    std::string units{};                                         ///< "s", "ms"; empty = none
    std::vector<std::pair<std::string, std::string>> meanings{}; ///< of its values, if they are few
    std::string hed{}; ///< HED string for every value, which it has as '#'; empty = none
    std::vector<std::pair<std::string, std::string>> hed_of{}; ///< HED strings by value; others have none
    bool is_name = false; ///< cells are texts, even if they look like numbers ("1.10", "007", "true")
    bool has_interval = false; ///< the next two columns are the ends of its interval
};
Column name_column(std::string name, std::string description);
/// Of an estimate whose interval is in the next two columns.
Column estimate_column(std::string name, std::string description, std::string units = {});

struct Table {
    std::vector<Column> columns;
    std::vector<std::vector<std::string>> rows{}; ///< each with one cell per column
};

inline constexpr std::string_view kNothing = "n/a";

/// The shortest text with at most nine digits; n/a if not finite.
std::string cell(double value);
/// The same with fifteen digits: of estimates, which may lie close to each other and far from 0.
std::string full_cell(double value);
std::string cell(std::optional<double> value);
std::string cell(int value);
std::string cell(bool value); ///< true, false
std::string cell(std::optional<bool> value);
/// n/a for an empty text. Control characters other than tabs and line ends become spaces.
std::string cell(std::string_view text);
inline std::string cell(char const* text) { return cell(std::string_view(text)); }
inline std::string cell(std::string const& text) { return cell(std::string_view(text)); }
/// Seconds with six decimals.
std::string seconds_cell(double seconds);

/// A line of column names and one per row, tab-separated. Tabs and line ends in cells become spaces, because the
/// format cannot represent them.
std::string tsv_text(Table const& table);
/// Comma-separated text (RFC 4180, lines end in "\n"); `nothing` replaces n/a, such as "NA" for R.
std::string csv_text(Table const& table, std::string_view nothing = kNothing);
/// A fact of a sidecar.
struct SidecarFact {
    std::string key; ///< "a.b" is the key b within a
    std::string value;
    bool is_json = false; ///< the value is JSON, else a text
};
/// The JSON sidecar that describes the columns (BIDS: Description, Units, Levels, HED), plus `facts`.
std::string sidecar_json(Table const& table, std::vector<SidecarFact> const& facts = {});
/// A name as HED takes it as a value: letters, digits, - and _; others become _.
std::string hed_name(std::string_view text);

/// A label for file names: the letters and digits of `text`, with a number appended if it is in `taken`.
std::string label_of(std::string_view text, std::vector<std::string> const& taken = {});

} // namespace study
