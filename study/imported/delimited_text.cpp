#include "study/imported/delimited_text.h"

#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>

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

class Reader {
public:
    Reader(std::string const& text, std::string const& file) : text_(text), file_(file)
    {
        if (text_.rfind("\xef\xbb\xbf", 0) == 0) at_ = 3;
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

DelimitedText read_delimited(std::string const& text, std::string const& file)
{
    DelimitedText t;
    t.file = file;
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
