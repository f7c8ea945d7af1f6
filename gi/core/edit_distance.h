#pragma once
#include <string>
#include <vector>

namespace gi {

/// Insertions, deletions, replacements and exchanges of neighbours that make one word of the other (optimal string
/// alignment).
int edit_distance(std::string const& a, std::string const& b);

/// "did you mean 'x'?" where a known word is near, else "there are: ..." (the first 24).
std::string suggest(std::string const& word, std::vector<std::string> const& known);

} // namespace gi
