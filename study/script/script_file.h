#pragma once
#include "study/script/script.h"

#include <filesystem>
#include <string>

namespace study {

/// Parses a script of schema study/1 (all keys: docs/study.md). Throws ScriptError with file:line:column if the
/// text is invalid, or the design is impossible or has parts that nothing uses.
/// @param name name of the text in messages
Script parse_script(std::string const& text, std::string const& name);

/// Throws ScriptError for the first Markdown file that the script names and `folder` lacks.
void check_text_files(Script const& script, std::filesystem::path const& folder);

} // namespace study
