#pragma once
#include <string>

namespace gi {

/// Levenshtein distance: number of letters to insert, delete or replace to turn one word into the other.
int edit_distance(std::string const& a, std::string const& b);

} // namespace gi
