#pragma once
// Parses the text of a study script.

#include "study/script/mistakes.h"
#include "study/script/script.h"

#include <filesystem>
#include <string>

namespace study {

/// Parses a script of schema study/1 or study/2 (all keys: docs/study/reference.md). Throws ScriptError with file:line:column if the
/// text is invalid, or the design is impossible or has parts that nothing uses.
/// @param name name of the text in messages
Script parse_script(std::string const& text, std::string const& name);

/// A script as far as it can be read, and all that is wrong with it.
struct ReadScript {
    Script script;
    Mistakes mistakes;
    bool is_whole = false; ///< its parts were read; false: it is not YAML, or no map
};
/// As parse_script(), but continues after mistakes. Blocks that cannot be planned are marked as broken.
ReadScript read_script(std::string const& text, std::string const& name);

/// Throws ScriptError for the first Markdown file that the script names and `folder` lacks.
void check_text_files(Script const& script, std::filesystem::path const& folder);
/// As check_text_files(), and adds each.
void find_missing_texts(Script const& script, std::filesystem::path const& folder, Mistakes& m);

} // namespace study
