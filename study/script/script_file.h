#pragma once
#include "study/script/script.h"

#include <filesystem>
#include <string>

namespace study {

/// Reads schema study/1 (docs/study.md has every key). Throws ScriptError with file:line:column where the text is
/// not that, or where the design is impossible or has parts that nothing uses.
/// @param name of the text in messages
Script parse_script(std::string const& text, std::string const& name);

/// Throws ScriptError at the first Markdown file that the script names and `folder` does not have.
void check_text_files(Script const& script, std::filesystem::path const& folder);

} // namespace study
