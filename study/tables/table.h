#pragma once
// Tables as texts: columns with what they mean, rows of cells that are written as they are. Numbers are as in the
// C locale whatever the machine's; "n/a" where there is nothing, as BIDS wants it.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace study {

struct TextFile {
    std::string path; ///< below a folder that the caller knows, with '/'
    std::string text;
};

struct Column {
    std::string name, description;
    std::string units{};                                         ///< "s", "ms"; empty = none
    std::vector<std::pair<std::string, std::string>> meanings{}; ///< of its values, where they are few
};

struct Table {
    std::vector<Column> columns;
    std::vector<std::vector<std::string>> rows{}; ///< as many cells each as there are columns
};

inline constexpr std::string_view kNothing = "n/a";

/// Nine digits at most, as short as they allow; n/a of what is no finite number.
std::string cell(double value);
std::string cell(std::optional<double> value);
std::string cell(int value);
std::string cell(bool value); ///< true, false
std::string cell(std::optional<bool> value);
/// n/a of an empty text. Tabs, line ends and other control characters become spaces: a table has no way to write
/// them.
std::string cell(std::string_view text);
inline std::string cell(char const* text) { return cell(std::string_view(text)); }
inline std::string cell(std::string const& text) { return cell(std::string_view(text)); }
/// Seconds with six decimals.
std::string seconds_cell(double seconds);

/// A line of column names and one per row, tabs between.
std::string tsv_text(Table const& table);
/// The same with commas (RFC 4180, lines end in "\n"); `nothing` instead of n/a, for R "NA".
std::string csv_text(Table const& table, std::string_view nothing = kNothing);
/// The JSON sidecar that describes the columns (BIDS: Description, Units, Levels) and what else is said;
/// "a.b" is the key b within a.
std::string sidecar_json(Table const& table, std::vector<std::pair<std::string, std::string>> const& facts = {});

/// Letters and digits only, first those of `text`, for names of files; told apart from `taken` by a number.
std::string label_of(std::string_view text, std::vector<std::string> const& taken = {});

} // namespace study
