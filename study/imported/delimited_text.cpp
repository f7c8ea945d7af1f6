#include "study/imported/delimited_text.h"

#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <utility>

namespace study {
namespace {

char separator_of(std::string const& text)
{
    std::string const head = text.substr(0, text.find('\n'));
    char best = ',';
    for (char const c : {';', '\t'})
        if (std::count(head.begin(), head.end(), c) > std::count(head.begin(), head.end(), best)) best = c;
    return best;
}

/// @throws ScriptError the text is not UTF-8, or has zero bytes
void check_encoding(std::string const& text, std::string const& file)
{
    constexpr char const* kSave = "save it as UTF-8 (of a spreadsheet: CSV UTF-8)";
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        throw ScriptError(file, {1, 1}, "the text is UTF-16", "tables are read as UTF-8", kSave);
    Place at{1, 1};
    for (std::size_t i = 0; i < text.size();) {
        std::size_t const n = gi::first_character(std::string_view(text).substr(i));
        if (n == 0)
            throw ScriptError(file, at, "the text is not UTF-8", "tables are read as UTF-8, this may be Latin-1",
                              kSave);
        if (text[i] == '\0') throw ScriptError(file, at, "a zero byte", "tables are text", kSave);
        at = text[i] == '\n' ? Place{at.line + 1, 1} : Place{at.line, at.column + int(n)};
        i += n;
    }
}

class Reader {
public:
    Reader(std::string const& text, std::string const& file) : text_(text), file_(file)
    {
        if (text_.rfind("\xef\xbb\xbf", 0) == 0) at_ = 3;
        while (!at_end() && (text_[at_] == '\n' || text_[at_] == '\r')) step();
        separator_ = separator_of(text_.substr(at_));
    }
    bool at_end() const { return at_ >= text_.size(); }

    std::vector<TextCell> row()
    {
        std::vector<TextCell> cells;
        for (bool more = true; more;) {
            cells.push_back(cell());
            more = !at_end() && text_[at_] == separator_;
            if (more) step();
        }
        if (!at_end()) step(); // the line's end
        return cells;
    }

private:
    void step()
    {
        if (text_[at_++] == '\n') {
            ++line_;
            column_ = 1;
        } else
            ++column_;
    }
    TextCell cell()
    {
        TextCell c;
        c.place = {line_, column_};
        while (!at_end() && text_[at_] == ' ') step();
        if (at_end() || text_[at_] != '"') {
            while (!at_end() && text_[at_] != separator_ && text_[at_] != '\n') {
                c.text += text_[at_];
                step();
            }
        } else {
            step();
            for (;;) {
                if (at_end())
                    throw ScriptError(file_, c.place, "a quote is not closed", "the file ends within this cell",
                                      "add the missing quote");
                bool const is_quote = text_[at_] == '"';
                bool const is_doubled = is_quote && at_ + 1 < text_.size() && text_[at_ + 1] == '"';
                if (is_quote && !is_doubled) break;
                if (is_doubled) step();
                c.text += text_[at_];
                step();
            }
            step();
            while (!at_end() && text_[at_] != separator_ && text_[at_] != '\n') step();
        }
        c.text = std::string(gi::trimmed(c.text));
        return c;
    }

    std::string const& text_;
    std::string const& file_;
    std::size_t at_ = 0;
    int line_ = 1, column_ = 1;
    char separator_ = ',';
};

} // namespace

int DelimitedText::column(std::string const& name) const
{
    auto const it = std::find(columns.begin(), columns.end(), name);
    return it == columns.end() ? -1 : int(it - columns.begin());
}

bool DelimitedText::is_missing(std::string const& text)
{
    for (char const* word : {"", "NA", "N/A", "n/a", "nan", "NaN", "None", "null"})
        if (text == word) return true;
    return false;
}

DelimitedText joined(std::vector<DelimitedText> const& tables)
{
    DelimitedText all;
    for (DelimitedText const& t : tables) {
        all.file += (all.file.empty() ? "" : ", ") + t.file;
        int const first_file = int(all.files.size());
        all.files.insert(all.files.end(), t.files.begin(), t.files.end());
        std::vector<std::size_t> at;
        for (std::string const& name : t.columns) {
            if (all.column(name) < 0) all.columns.push_back(name);
            at.push_back(std::size_t(all.column(name)));
        }
        for (auto const& row : t.rows) {
            std::vector<TextCell> cells(all.columns.size(), TextCell{"", {row.front().place.line, 0}, first_file});
            for (std::size_t c = 0; c < row.size(); ++c) {
                cells[at[c]] = row[c];
                cells[at[c]].file += first_file;
            }
            all.rows.push_back(std::move(cells));
        }
    }
    for (auto& row : all.rows)
        row.resize(all.columns.size(), TextCell{"", {row.front().place.line, 0}, row.front().file});
    if (all.files.size() > 3) all.file = fmt::format("{} and {} others", all.files.front(), all.files.size() - 1);
    return all;
}

DelimitedText to_wide(DelimitedText const& table, std::string const& names, std::string const& values)
{
    int const name_at = table.column(names), value_at = table.column(values);
    for (auto const& [column, at] : {std::pair(names, name_at), std::pair(values, value_at)})
        if (at < 0)
            throw ScriptError(table.file, {1, 1}, fmt::format("there is no column '{}'", column),
                              "--long names it", "check the names in the first line");
    DelimitedText wide;
    wide.file = table.file;
    wide.files = table.files;
    std::vector<std::size_t> keys;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (int(c) != name_at && int(c) != value_at) {
            keys.push_back(c);
            wide.columns.push_back(table.columns[c]);
        }
    std::map<std::vector<std::string>, std::size_t> trials;
    std::vector<std::vector<bool>> is_set;
    for (auto const& row : table.rows) {
        std::vector<std::string> key{std::to_string(row.front().file)};
        for (std::size_t const k : keys) key.push_back(row[k].text);
        auto const [it, is_new] = trials.emplace(key, wide.rows.size());
        if (is_new) {
            wide.rows.emplace_back();
            is_set.emplace_back();
            for (std::size_t const k : keys) wide.rows.back().push_back(row[k]);
        }
        TextCell const& name = row[std::size_t(name_at)];
        if (wide.column(name.text) < 0) wide.columns.push_back(name.text);
        auto const at = std::size_t(wide.column(name.text));
        auto& cells = wide.rows[it->second];
        auto& set = is_set[it->second];
        cells.resize(std::max(cells.size(), at + 1), TextCell{"", row.front().place, row.front().file});
        set.resize(std::max(set.size(), at + 1), false);
        if (set[at] || at < keys.size())
            throw ScriptError(table.files[std::size_t(name.file)], name.place,
                              fmt::format("'{}' for the second time", name.text),
                              "the other columns do not tell the trials apart",
                              "add a column with the number of the trial");
        set[at] = true;
        cells[at] = row[std::size_t(value_at)];
    }
    for (auto& row : wide.rows) row.resize(wide.columns.size(), TextCell{"", row.front().place, row.front().file});
    return wide;
}

DelimitedText read_delimited(std::string text, std::string const& file)
{
    check_encoding(text, file);
    if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
    DelimitedText t;
    t.file = file;
    t.files = {file};
    Reader reader(text, file);
    std::vector<TextCell> const head = reader.at_end() ? std::vector<TextCell>{} : reader.row();
    for (TextCell const& c : head) {
        // Programs that write row numbers leave their column without a name, those that end lines in a comma too.
        std::string const name = c.text.empty() ? fmt::format("column {}", t.columns.size() + 1) : c.text;
        if (t.column(name) >= 0)
            throw ScriptError(file, c.place, fmt::format("two columns are named '{}'", name),
                              "a name must say which column is meant", "rename one of them");
        t.columns.push_back(name);
    }
    if (head.size() < 2)
        throw ScriptError(file, {1, 1}, fmt::format("{} columns", head.size()),
                          "the first line has the names of columns, separated by commas, semicolons or tabs",
                          "check that this is a table");
    while (!reader.at_end()) {
        std::vector<TextCell> cells = reader.row();
        if (cells.size() == 1 && cells[0].text.empty()) continue;
        if (cells.size() != head.size())
            throw ScriptError(file, cells.front().place,
                              fmt::format("{} cells in a table of {} columns", cells.size(), head.size()),
                              "each row has one cell for each column name",
                              "check quotes and separators of this line");
        t.rows.push_back(std::move(cells));
    }
    return t;
}

} // namespace study
