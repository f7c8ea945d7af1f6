#pragma once
#include <string>

namespace gi {

/// How many letters have to be inserted, deleted or replaced to make one word of the other (Levenshtein).
int edit_distance(std::string const& a, std::string const& b);

} // namespace gi
