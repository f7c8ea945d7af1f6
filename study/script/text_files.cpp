#include "study/script/script_file.h"

namespace study {

bool is_text_file(std::string const& text)
{
    return text.ends_with(".md") && text.find('\n') == std::string::npos && text.size() < 256;
}

namespace {

void check_text_file(Script const& s, std::filesystem::path const& folder, std::string const& text, Place where)
{
    std::error_code failure;
    if (is_text_file(text) && !std::filesystem::is_regular_file(folder / text, failure))
        throw ScriptError(s.file, where, "there is no file '" + text + "'", "it must be beside the script",
                          "create it, or write the text itself here");
}

void check_texts(Script const& s, std::filesystem::path const& folder, std::vector<SequenceItem> const& items,
                 Mistakes& m)
{
    for (SequenceItem const& item : items) {
        if (item.kind == SequenceKind::instructions)
            m.attempt([&] { check_text_file(s, folder, item.text, item.place); });
        check_texts(s, folder, item.items, m);
    }
}

} // namespace

void find_missing_texts(Script const& s, std::filesystem::path const& folder, Mistakes& m)
{
    m.attempt([&] { check_text_file(s, folder, s.participants.consent, s.participants.place); });
    check_texts(s, folder, s.sequence, m);
    for (Block const& b : s.blocks) m.attempt([&] { check_text_file(s, folder, b.instructions, b.place); });
}

void check_text_files(Script const& script, std::filesystem::path const& folder)
{
    Mistakes m;
    find_missing_texts(script, folder, m);
    if (!m.empty()) throw m.in_order().front();
}

} // namespace study
