#pragma once
// Commands as people paste them into a shell.

#include <string>

namespace gi {

/// Quotes one word for a POSIX shell, if it needs quotes.
std::string shell_quoted(std::string const& word);

} // namespace gi
