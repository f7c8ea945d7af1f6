#pragma once
// What in a table makes it doubtful that it says what its author means: cautions, as sentences without the name of the file.

#include "study/imported/delimited_text.h"

#include <map>

namespace study {

/// Names that differ only in case, blanks, zeros before a number, or a ".0" after it, as pairs in the order of the names.
std::vector<std::pair<std::string, std::string>> similar_names(std::vector<std::string> const& names);
/// "participants 'P1' and 'p1' differ only in case, ..."; empty if no two of them do.
/// @param what  "participants", "items", "levels of 'scene'"
std::string similar_names_caution(std::string const& what, std::vector<std::string> const& names);

/// A caution if each row occurs as often as others, or those of some participants do, such as twice: a table that was joined with
/// itself. Columns that number the rows do not count. Equal rows alone are no doubt, since answers repeat.
/// @param participants  id of each row's participant
std::string repeated_rows_caution(std::vector<std::vector<TextCell> const*> const& rows,
                                  std::vector<std::string> const& participants);

/// A number that programs write for a missing value (-9, 99, -999, ...), and that is far outside of all other numbers.
struct MissingCode {
    double code = 0;
    int count = 0;
    double low = 0, high = 0; ///< range of the other numbers
};
enum class NumberKind {
    judgements, ///< differences count: ratings, ages
    ratios,     ///< they grow by factors: levels, magnitudes
    times       ///< reaction times, with a long tail
};
/// Numbers that are codes (-1, 9, 77, 88, 99, 999, ... of either sign) and farther from all others than these from each other:
/// of judgements that are whole numbers half as far, and below 0 where no other is; of times twice as far.
std::vector<MissingCode> missing_codes(std::vector<double> const& numbers, NumberKind kind);
/// Whether programs write this number for a missing value: -1, 9, -99, 999, ...
bool is_missing_code(double v);
/// @param option  what excludes the code, such as "--missing -99"
std::string missing_code_caution(std::string const& column, MissingCode const& code, std::string const& option);

/// A factor whose name says what people are, not what they see: group, age, sex, cohort, ...
bool names_people(std::string const& factor);
/// Ids as people are numbered: 1, 2, 3 or P01, P02, without large gaps.
bool are_numbered(std::vector<std::string> const& ids);

/// "1, 2, 3, ..."
std::string named_few(std::vector<std::string> const& names, std::size_t most = 5);

} // namespace study
