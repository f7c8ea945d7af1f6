#include "study/imported/delimited_text.h"

#include "gi/core/text.h"
#include "study/imported/decimal_number.h"
#include "study/imported/table_encoding.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace study {
namespace {

constexpr std::string_view kMark = "\xef\xbb\xbf"; ///< byte-order mark, also where files were joined

/// How often a character is in a line outside quotes.
int count_of(char c, std::string_view line)
{
    int n = 0;
    bool is_quoted = false;
    for (char const other : line) {
        if (other == '"') is_quoted = !is_quoted;
        n += other == c && !is_quoted;
    }
    return n;
}

/// The most frequent one in the line of column names; before it tabs, and, of two, the one that is as frequent in the
/// line below: names may have commas, as in "time, ms".
char separator_of(std::string_view names, std::string_view below)
{
    char best = ',';
    int most = 0;
    for (char const c : {'\t', ';', ','}) {
        int const n = count_of(c, names);
        bool const is_alike = n > 0 && n == count_of(c, below);
        if (c == '\t' && is_alike) return c;
        int const score = n == 0 ? 0 : n + (is_alike ? 1'000'000 : 0);
        if (score > most) {
            best = c;
            most = score;
        }
    }
    return best;
}

class Reader {
public:
    Reader(std::string_view text, std::string const& file) : text_(text), file_(&file)
    {
        skip_empty();
        std::string_view const line = rest_of_line();
        std::size_t const at = line.starts_with("sep=")     ? 4
                               : line.starts_with("\"sep=") ? 5
                                                            : std::string_view::npos;
        if (at >= line.size() || std::string_view(",;\t").find(line[at]) == std::string_view::npos) return;
        given_ = line[at];
        skip_line();
        skip_empty();
    }
    bool at_end() const { return at_ >= text_.size(); }
    bool at_comment() const { return !at_end() && text_[at_] == '#'; }
    std::string_view rest_of_line() const
    {
        std::size_t const end = std::min(text_.find_first_of("\n\r", at_), text_.size());
        return text_.substr(at_, end - at_);
    }
    void separate_as(std::string_view names, std::string_view below)
    {
        separator_ = given_ ? *given_ : separator_of(names, below);
    }
    char separator() const { return separator_; }
    void skip_line()
    {
        while (!at_end() && !at_line_end()) step();
        end_line();
    }
    void skip_empty()
    {
        while (!at_end() && (at_line_end() || text_.substr(at_).starts_with(kMark)))
            at_line_end() ? end_line() : skip_mark();
    }
    std::vector<TextCell> row()
    {
        skip_mark();
        std::vector<TextCell> cells;
        for (bool more = true; more;) {
            cells.push_back(cell());
            more = !at_end() && text_[at_] == separator_;
            if (more) step();
        }
        end_line();
        return cells;
    }

private:
    bool at_line_end() const { return text_[at_] == '\n' || text_[at_] == '\r'; }
    void skip_mark()
    {
        if (text_.substr(std::min(at_, text_.size())).starts_with(kMark)) at_ += kMark.size();
    }
    void end_line()
    {
        if (at_end()) return;
        if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
        step();
    }
    void step()
    {
        char const c = text_[at_++];
        if (c == '\n' || (c == '\r' && (at_end() || text_[at_] != '\n'))) {
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
        auto const at_cell_end = [&] { return at_end() || text_[at_] == separator_ || at_line_end(); };
        if (at_end() || text_[at_] != '"') {
            while (!at_cell_end()) {
                c.text += text_[at_];
                step();
            }
        } else {
            step();
            for (;;) {
                if (at_end())
                    throw ScriptError(*file_, c.place, "a quote is not closed", "the file ends within this cell",
                                      "add the missing quote");
                bool const is_quote = text_[at_] == '"';
                bool const is_doubled = is_quote && at_ + 1 < text_.size() && text_[at_ + 1] == '"';
                if (is_quote && !is_doubled) break;
                if (is_doubled) step();
                c.text += text_[at_];
                step();
            }
            step();
            while (!at_cell_end()) step();
        }
        c.text = std::string(gi::trimmed(c.text));
        return c;
    }

    std::string_view text_;
    std::string const* file_;
    std::size_t at_ = 0;
    int line_ = 1, column_ = 1;
    char separator_ = ',';
    std::optional<char> given_;
};

/// Number of cells up to the last one that is not empty.
std::size_t filled(std::vector<TextCell> const& cells)
{
    std::size_t n = cells.size();
    while (n > 0 && cells[n - 1].text.empty()) --n;
    return n;
}

bool has_number(std::vector<TextCell> const& cells)
{
    return std::any_of(cells.begin(), cells.end(),
                       [](TextCell const& c) { return read_decimal(c.text).has_value(); });
}

/// The cells of column names. A last comment before the first row is that line if it has as many cells and the row has
/// numbers: so does numpy.savetxt.
std::vector<TextCell> read_head(Reader& reader, int& comments)
{
    std::optional<Reader> last_comment;
    while (reader.at_comment()) {
        last_comment = reader;
        reader.skip_line();
        reader.skip_empty();
        ++comments;
    }
    std::string_view const line = last_comment ? last_comment->rest_of_line() : std::string_view();
    if (last_comment && std::count(line.begin(), line.end(), '"') % 2 == 0) {
        Reader head = *last_comment, first = reader;
        for (Reader* const r : {&head, &first}) r->separate_as(line, reader.rest_of_line());
        std::vector<TextCell> cells = head.row();
        if (!first.at_end() && cells.size() > 1) {
            auto const row = first.row();
            if (filled(row) <= cells.size() && row.size() >= filled(cells) && has_number(row)) {
                --comments;
                reader.separate_as(line, reader.rest_of_line());
                if (cells[0].text.starts_with("# "))
                    cells[0].text = std::string(gi::trimmed(cells[0].text.substr(1)));
                return cells;
            }
        }
    }
    Reader below = reader;
    below.skip_line();
    below.skip_empty();
    reader.separate_as(reader.rest_of_line(), below.rest_of_line());
    return reader.at_end() ? std::vector<TextCell>{} : reader.row();
}

std::vector<std::string> texts_of(std::vector<TextCell> const& cells, std::size_t count)
{
    std::vector<std::string> out;
    for (std::size_t i = 0; i < std::min(count, cells.size()); ++i) out.push_back(cells[i].text);
    return out;
}

/// "3 lines of comments skipped". @param first  line of the first one; 0 = it does not matter
std::string skipped(int n, char const* one, char const* more, int first)
{
    std::string const where =
        first == 0 ? "" : fmt::format(" ({} {})", n == 1 ? "line" : "the first is line", first);
    return fmt::format("{} {} skipped{}", n, n == 1 ? one : more, where);
}

bool are_equal(DelimitedText const& a, DelimitedText const& b)
{
    auto const same = [](TextCell const& x, TextCell const& y) { return x.text == y.text; };
    return a.columns == b.columns &&
           std::equal(a.rows.begin(), a.rows.end(), b.rows.begin(), b.rows.end(),
                      [&](auto const& x, auto const& y) {
                          return std::equal(x.begin(), x.end(), y.begin(), y.end(), same);
                      });
}

void check_different(std::vector<DelimitedText> const& tables)
{
    for (std::size_t i = 0; i < tables.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (!tables[i].rows.empty() && are_equal(tables[i], tables[j]))
                throw ScriptError(tables[i].file, {},
                                  tables[i].file == tables[j].file
                                      ? "the file is given twice"
                                      : fmt::format("the file has the same rows as '{}'", tables[j].file),
                                  "each trial would count twice", "leave one of them out");
}

/// Names of files without folders and endings, or, if two of these are equal, as they are.
std::vector<std::string> short_names(std::vector<std::string> const& files)
{
    std::vector<std::string> names;
    for (std::string const& f : files) names.push_back(std::filesystem::path(f).stem().string());
    return std::set(names.begin(), names.end()).size() == names.size() ? names : files;
}

} // namespace

int DelimitedText::column(std::string const& name) const
{
    auto const it = std::find(columns.begin(), columns.end(), name);
    return it == columns.end() ? -1 : int(it - columns.begin());
}

void DelimitedText::check_one_column(std::string const& name) const
{
    auto const first = std::find(columns.begin(), columns.end(), name);
    if (first == columns.end()) return;
    auto const second = std::find(first + 1, columns.end(), name);
    if (second == columns.end()) return;
    TextCell const& head = heads[std::size_t(second - columns.begin())];
    throw ScriptError(files[std::size_t(head.file)], head.place, fmt::format("two columns are named '{}'", name),
                      "a name must say which column is meant", "rename one of them");
}

bool DelimitedText::is_missing(std::string const& text)
{
    for (char const* word : {"", "NA", "N/A", "n/a", "#N/A", "<NA>", "nan", "NaN", "NAN", "None", "null", "NULL",
                             "undefined", "--", "."})
        if (text == word) return true;
    return false;
}

DelimitedText joined(std::vector<DelimitedText> const& tables)
{
    check_different(tables);
    DelimitedText all;
    using Name = std::pair<std::string, int>; // and its number among equal ones
    std::map<Name, std::size_t> place;
    for (DelimitedText const& t : tables) {
        all.file += (all.file.empty() ? "" : ", ") + t.file;
        int const first_file = int(all.files.size());
        all.files.insert(all.files.end(), t.files.begin(), t.files.end());
        all.separators += t.separators;
        for (std::string const& note : t.notes)
            all.notes.push_back(tables.size() > 1 && !note.starts_with(t.file) ? t.file + ": " + note : note);
        std::vector<std::size_t> at;
        std::map<std::string, int> seen;
        for (std::size_t c = 0; c < t.columns.size(); ++c) {
            auto const [it, is_new] = place.emplace(Name(t.columns[c], seen[t.columns[c]]++), all.columns.size());
            if (is_new) {
                all.columns.push_back(t.columns[c]);
                all.heads.push_back(t.heads[c]);
                all.heads.back().file += first_file;
            }
            at.push_back(it->second);
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

DelimitedText with_file_names(DelimitedText const& table)
{
    DelimitedText t = table;
    auto const names = short_names(t.files);
    t.columns.emplace_back("file");
    t.heads.push_back({"file", {1, 1}, 0});
    for (auto& row : t.rows) {
        TextCell const& first = row.front();
        row.push_back({names[std::size_t(first.file)], {first.place.line, 0}, first.file});
    }
    return t;
}

std::string label_of(DelimitedText const& table)
{
    constexpr std::size_t kMostNamed = 3;
    std::vector<std::string> names = short_names(table.files);
    if (names.size() > kMostNamed) return fmt::format("{} and {} others", names[0], names.size() - 1);
    std::string const last = names.back();
    names.pop_back();
    return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

DelimitedText to_wide(DelimitedText const& table, std::string const& names, std::string const& values)
{
    constexpr std::size_t kMostNames = 1000, kManyCells = 10'000'000; // of 48 bytes
    int const name_at = table.column(names), value_at = table.column(values);
    for (auto const& [column, at] : {std::pair(names, name_at), std::pair(values, value_at)})
        if (at < 0)
            throw ScriptError(table.file, {1, 1}, fmt::format("there is no column '{}'", column),
                              "--long names it", "check the names in the first line");
    for (std::string const& name : {names, values}) table.check_one_column(name);
    DelimitedText wide;
    wide.file = table.file;
    wide.files = table.files;
    wide.separators = table.separators;
    wide.notes = table.notes;
    std::vector<std::size_t> keys;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (int(c) != name_at && int(c) != value_at) {
            keys.push_back(c);
            wide.columns.push_back(table.columns[c]);
            wide.heads.push_back(table.heads[c]);
        }
    std::map<std::string, std::size_t> place; // of columns
    for (std::size_t c = 0; c < wide.columns.size(); ++c) place.emplace(wide.columns[c], c);
    std::set<std::string_view> named;
    for (auto const& row : table.rows) named.insert(row[std::size_t(name_at)].text);
    auto const refuse_if = [&](bool is_too_many) {
        if (!is_too_many) return;
        TextCell const& head = table.heads[std::size_t(name_at)];
        throw ScriptError(
            table.files[std::size_t(head.file)], head.place,
            fmt::format("column '{}' has {} different texts", names, named.size()),
            fmt::format("--long makes a column of each, at most {}, fewer for many trials", kMostNames),
            "name the column whose cells are names of values, such as 'name'");
    };
    refuse_if(named.size() > kMostNames);
    std::size_t const most_cells = std::max(kManyCells, 10 * table.rows.size() * table.columns.size());
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
        auto const [column, is_first] = place.emplace(name.text, wide.columns.size());
        if (is_first) {
            wide.columns.push_back(name.text);
            wide.heads.push_back(name);
        }
        refuse_if(wide.rows.size() * wide.columns.size() > most_cells);
        std::size_t const at = column->second;
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

DelimitedText read_delimited(std::string bytes, std::string const& file)
{
    DecodedText const decoded = decoded_table(std::move(bytes), file);
    DelimitedText t;
    t.file = file;
    t.files = {file};
    if (!decoded.note.empty()) t.notes.push_back(decoded.note);
    Reader reader(decoded.text, file);
    int comments = 0, repeated = 0, first_repeated = 0, shorter = 0, first_shorter = 0;
    std::vector<TextCell> const head = read_head(reader, comments);
    t.separators = reader.separator();
    for (TextCell const& c : head) {
        // Programs that write row numbers leave their column without a name, those that end lines in a comma too.
        t.columns.push_back(c.text.empty() ? fmt::format("column {}", t.columns.size() + 1) : c.text);
        t.heads.push_back(c);
    }
    if (head.size() < 2)
        throw ScriptError(file, {1, 1}, fmt::format("{} columns", head.size()),
                          "the first line has the names of columns, separated by commas, semicolons or tabs",
                          "check that this is a table");
    std::size_t const named = filled(head);
    std::vector<std::string> const names = texts_of(head, named);
    std::vector<std::string> sorted = names;
    std::sort(sorted.begin(), sorted.end());
    for (reader.skip_empty(); !reader.at_end(); reader.skip_empty()) {
        if (reader.at_comment()) {
            // An item may be called "#1"; a comment has other cells than the rows, or a blank after the sign.
            Reader as_row = reader;
            as_row.skip_line();
            std::string_view const line = reader.rest_of_line();
            auto const cells = std::size_t(std::count(line.begin(), line.end(), reader.separator())) + 1;
            if (cells != head.size() || line.starts_with("# ")) {
                ++comments;
                reader = as_row;
                continue;
            }
        }
        std::vector<TextCell> cells = reader.row();
        if (cells.size() == 1 && cells[0].text.empty()) continue;
        std::size_t const own = filled(cells);
        if (own == named && texts_of(cells, own) == names) {
            first_repeated = repeated++ == 0 ? cells[0].place.line : first_repeated;
            continue;
        }
        if (own == named) {
            std::vector<std::string> texts = texts_of(cells, own);
            std::sort(texts.begin(), texts.end());
            if (texts == sorted)
                throw ScriptError(file, cells.front().place,
                                  "column names in another order than in the first line",
                                  "tables with other columns seem to be joined here",
                                  "give them as several files: --table FILE FILE");
        }
        if (own > head.size() || cells.size() == 1)
            throw ScriptError(file, cells.front().place,
                              fmt::format("{} cells in a table of {} columns", cells.size(), head.size()),
                              "each row has one cell for each column name",
                              reader.separator() == ','
                                  ? "check quotes and separators of this line: decimal commas need quotes"
                                  : "check quotes and separators of this line");
        if (cells.size() < named) first_shorter = shorter++ == 0 ? cells[0].place.line : first_shorter;
        TextCell const missing{"", {cells.back().place.line, cells.back().place.column}, 0};
        cells.resize(head.size(), missing);
        t.rows.push_back(std::move(cells));
    }
    if (repeated > 0)
        t.notes.push_back(
            skipped(repeated, "further line of column names", "further lines of column names", first_repeated));
    if (comments > 0) t.notes.push_back(skipped(comments, "line of comments", "lines of comments", 0));
    if (shorter > 0)
        t.notes.push_back(fmt::format("{} (the first is line {}): the rest is missing",
                                      shorter == 1 ? "1 row ends before the last column"
                                                   : fmt::format("{} rows end before the last column", shorter),
                                      first_shorter));
    return t;
}

} // namespace study
