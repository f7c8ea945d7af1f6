#pragma once
// Suggests the known word that a mistyped one was probably meant to be, for messages.

#include <optional>
#include <string>
#include <vector>

namespace gi {

/// Insertions, deletions, replacements and exchanges of neighbours that make one word
/// of the other (optimal string alignment).
int edit_distance(std::string const& a, std::string const& b);

/// The nearest known word, if its distance is at most half of the word's length, or one.
std::optional<std::string> nearest_word(std::string const& word, std::vector<std::string> const& known);

/// "did you mean 'x'?" where a known word is near, else `otherwise`, or, if that is empty, "there are: ..." (of
/// more than 48 the first 24, and how many more).
std::string suggest(std::string const& word, std::vector<std::string> const& known,
                    std::string const& otherwise = "");

} // namespace gi
