#include "study/tables/export.h"

#include "study/script/script_error.h"

#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <sqlite3.h>
#include <stdexcept>

namespace study {
namespace {

struct Close {
    void operator()(sqlite3* db) const { sqlite3_close(db); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, Close>;
using Statement = std::unique_ptr<sqlite3_stmt, Close>;

void check(Database const& db, int result)
{
    if (result != SQLITE_OK && result != SQLITE_DONE)
        throw std::runtime_error(fmt::format("SQLite: {}", sqlite3_errmsg(db.get())));
}

void run(Database const& db, std::string const& sql)
{
    check(db, sqlite3_exec(db.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::string identifier(std::string const& name)
{
    std::string out = "\"";
    for (char const c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

enum class Kind { integer, real, text };

Kind kind_of(Table const& table, std::size_t column)
{
    Kind kind = Kind::integer;
    bool is_empty = true;
    for (auto const& row : table.rows) {
        std::string const& c = row[column];
        if (c == kNothing) continue;
        is_empty = false;
        char* end = nullptr;
        static_cast<void>(std::strtod(c.c_str(), &end));
        bool const is_number = c.find_first_not_of("0123456789+-.e") == std::string::npos;
        if (!is_number || end != c.c_str() + c.size()) return Kind::text;
        if (c.find_first_not_of("-0123456789") != std::string::npos || c.size() > 15) kind = Kind::real;
    }
    return is_empty ? Kind::text : kind;
}

void add(Database const& db, NamedTable const& t)
{
    std::string columns, places;
    std::vector<Kind> kinds;
    constexpr char const* kNames[] = {"INTEGER", "REAL", "TEXT"};
    for (std::size_t c = 0; c < t.table.columns.size(); ++c) {
        kinds.push_back(kind_of(t.table, c));
        columns += fmt::format("{}{} {}", c ? ", " : "", identifier(t.table.columns[c].name),
                               kNames[std::size_t(kinds.back())]);
        places += c ? ", ?" : "?";
    }
    run(db, fmt::format("CREATE TABLE {} ({})", identifier(t.name), columns));
    sqlite3_stmt* raw = nullptr;
    std::string const sql = fmt::format("INSERT INTO {} VALUES ({})", identifier(t.name), places);
    check(db, sqlite3_prepare_v2(db.get(), sql.c_str(), -1, &raw, nullptr));
    Statement const insert(raw);
    for (auto const& row : t.table.rows) {
        for (std::size_t c = 0; c < row.size(); ++c) {
            int const at = int(c) + 1;
            if (row[c] == kNothing)
                check(db, sqlite3_bind_null(raw, at));
            else if (kinds[c] == Kind::integer)
                check(db, sqlite3_bind_int64(raw, at, std::strtoll(row[c].c_str(), nullptr, 10)));
            else if (kinds[c] == Kind::real)
                check(db, sqlite3_bind_double(raw, at, std::strtod(row[c].c_str(), nullptr)));
            else
                check(db, sqlite3_bind_text(raw, at, row[c].data(), int(row[c].size()), SQLITE_STATIC));
        }
        check(db, sqlite3_step(raw));
        check(db, sqlite3_reset(raw));
    }
}

} // namespace

void check_may_become_sqlite(std::filesystem::path const& file)
{
    std::string const magic("SQLite format 3", 16); // with the zero at its end
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return;
    std::string begin(magic.size(), '\0');
    std::ifstream(file, std::ios::binary).read(begin.data(), std::streamsize(begin.size()));
    if (begin == magic) return;
    throw ScriptError(file.string(), {}, "this file is no SQLite database", "it would be overwritten",
                      "name another file, or remove it");
}

void write_sqlite(std::filesystem::path const& file, std::vector<NamedTable> const& tables)
{
    sqlite3* raw = nullptr;
    int const opened = sqlite3_open(file.c_str(), &raw);
    Database const db(raw);
    check(db, opened);
    run(db, "PRAGMA journal_mode = MEMORY");
    run(db, "BEGIN");
    for (NamedTable const& t : tables) add(db, t);
    run(db, "CREATE TABLE columns (\"table\" TEXT, name TEXT, description TEXT, units TEXT)");
    sqlite3_stmt* statement = nullptr;
    check(db, sqlite3_prepare_v2(db.get(), "INSERT INTO columns VALUES (?, ?, ?, ?)", -1, &statement, nullptr));
    Statement const insert(statement);
    for (NamedTable const& t : tables)
        for (Column const& c : t.table.columns) {
            int at = 0;
            for (std::string const* text : {&t.name, &c.name, &c.description, &c.units})
                check(db, sqlite3_bind_text(statement, ++at, text->data(), int(text->size()), SQLITE_STATIC));
            check(db, sqlite3_step(statement));
            check(db, sqlite3_reset(statement));
        }
    run(db, "COMMIT");
}

} // namespace study
