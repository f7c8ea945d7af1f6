#include "study/imported/trial_table.h"

#include "gi/core/quantile.h"
#include "gi/core/text.h"
#include "study/imported/decimal_number.h"
#include "study/imported/made_trials.h"
#include "study/imported/table_doubts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace study {
namespace {

constexpr std::string_view kRoles[] = {
    "participant",  "run",           "item",       "first",       "second",     "chosen",
    "first_chosen", "chosen_from_0", "first_wins", "second_wins", "ties",       "value",
    "level",        "signal",        "correct",    "yes",         "trials",     "correct_count",
    "wrong_count",  "yes_count",     "no_count",   "percent",     "reaction_s", "reaction_ms"};

constexpr int kMostImportedTrials = 2'000'000;
constexpr double kLargestValue = 1e15; ///< whole numbers are exact up to it, and squares do not overflow

std::string lower_case(std::string text)
{
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return text;
}

std::string known_roles()
{
    std::string out;
    for (std::string_view const r : kRoles) out += (out.empty() ? "" : ", ") + std::string(r);
    return out;
}

/// A position in a pair: 0, 1 or 2, also as other programs write whole numbers, "1.0".
std::optional<int> position_of(std::string const& text)
{
    auto const v = read_decimal(text);
    return v && (v->value == 0 || v->value == 1 || v->value == 2) ? std::optional(int(v->value)) : std::nullopt;
}

/// Columns that a role names: "group+id" are two, if none is called so, of the roles that are names.
std::vector<std::string> parts_of(DelimitedText const& table, std::string const& role, std::string const& column)
{
    std::vector<std::string> parts;
    bool const may_join = (role == "participant" || role == "run") && table.column(column) < 0;
    for (std::size_t at = 0; may_join && at <= column.size();) {
        std::size_t const end = std::min(column.find('+', at), column.size());
        parts.push_back(std::string(gi::trimmed(std::string_view(column).substr(at, end - at))));
        at = end + 1;
    }
    return may_join ? parts : std::vector{column};
}

class Importer {
public:
    Importer(DelimitedText const& table, ColumnRoles const& roles) : t_(table), roles_(roles)
    {
        for (auto const& [role, column] : roles.column) {
            for (std::string const& part : parts_of(t_, role, column))
                parts_[role].push_back(std::size_t(column_of(part, "--columns names it")));
            at_[role] = int(parts_[role].front());
        }
        for (std::string const& f : roles.factors) factors_.push_back(column_of(f, "--factors names it"));
        for (auto const& [column, unused] : roles.only) column_of(column, "--only names it");
        for (auto const& [column, text] : roles.missing) codes_.push_back({text, columns_of_code(column)});
    }

    ImportedTable import()
    {
        if (roles_.is_matrix) {
            read_matrix();
        } else {
            made_.task = task();
            check_roles();
            for (auto const& row : t_.rows) read(row);
            check_percent();
            check_thousands();
            resolve_positions();
            note_ambiguous_choices();
            note_buttons();
            note_reaction_unit();
            note_codes();
            note_files();
            if (std::string caution = repeated_rows_caution(used_, ids_); !caution.empty())
                made_.notes.push_back(std::move(caution));
        }
        if (made_.trials.empty())
            throw ScriptError(t_.file, {}, "no trials are left", notes_of_rows(), "check --columns and --only");
        made_.id = roles_.id.empty() ? label_of(t_) : roles_.id;
        made_.file = t_.file;
        made_.notes.insert(made_.notes.begin(), t_.notes.begin(), t_.notes.end());
        made_.scale = roles_.scale;
        made_.harder_up = roles_.harder_up;
        made_.level_name = has("level") ? roles_.column.at("level") : "level";
        if (has("participant")) made_.participant_column = roles_.column.at("participant");
        for (std::string const& f : roles_.factors) made_.factors.push_back(f);
        if (rounded_ > 0)
            made_.notes.push_back(fmt::format(
                "{} percentages are no whole numbers of trials: they are rounded to the nearest", rounded_));
        ImportedTable out = sessions_of(made_);
        for (auto const& [why, n] : left_out_)
            out.notes.insert(out.notes.begin(), fmt::format("{} of {} rows left out: {}", n, t_.rows.size(), why));
        return out;
    }

private:
    using Row = std::vector<TextCell>;
    /// An answer by its position in the pair.
    struct Position {
        std::size_t trial; ///< of made_.trials
        TextCell const* cell;
        int number; ///< 0, 1 or 2, as written
        bool is_button;
    };
    /// What stands for a missing value.
    struct Code {
        std::string text;
        std::vector<std::size_t> columns;
        bool is_found = false;
    };

    [[noreturn]] void refuse_cell(TextCell const& c, std::string const& column, std::string const& why,
                                  std::string const& suggestion) const
    {
        throw ScriptError(t_.files[std::size_t(c.file)], c.place,
                          fmt::format("'{}' in column '{}'", c.text, column), why, suggestion);
    }
    [[noreturn]] void refuse_roles(std::string const& problem, std::string const& suggestion) const
    {
        throw ScriptError(t_.file, {}, problem, "--columns does not name enough to analyse these trials",
                          suggestion);
    }
    int column_of(std::string const& name, std::string const& who) const
    {
        t_.check_one_column(name);
        int const at = t_.column(name);
        if (at >= 0) return at;
        std::string known;
        for (std::string const& c : t_.columns) known += (known.empty() ? "" : ", ") + c;
        throw ScriptError(t_.file, {1, 1}, fmt::format("there is no column '{}'", name), who,
                          "the table has: " + known);
    }
    bool has(std::string const& role) const { return at_.count(role) > 0; }
    TextCell const& cell(Row const& row, std::string const& role) const { return row[std::size_t(at_.at(role))]; }
    /// The cells of all columns of the role: "young+1".
    std::string name(Row const& row, std::string const& role) const
    {
        std::string text;
        for (std::size_t const column : parts_.at(role)) text += (text.empty() ? "" : "+") + row[column].text;
        return text;
    }
    double number(Row const& row, std::string const& role)
    {
        TextCell const& c = cell(row, role);
        std::string const& column = roles_.column.at(role);
        auto const v = read_decimal(c.text);
        if (!v)
            refuse_cell(c, column, fmt::format("'{}' is a number", role),
                        c.text.find(',') == std::string::npos
                            ? "use digits with a decimal point"
                            : "use digits with a decimal point or comma, and nothing between thousands");
        numbers_[role].push_back(v->value);
        if (v->mark == '\0') return v->value;
        Decimals& found = decimals_[{c.file, at_.at(role)}];
        TextCell const*& same = v->mark == ',' ? found.comma : found.point;
        TextCell const* const other = v->mark == ',' ? found.point : found.comma;
        if (other != nullptr)
            refuse_cell(c, column,
                        fmt::format("the column has decimal {} too, '{}' in line {}",
                                    v->mark == ',' ? "points" : "commas", other->text, other->place.line),
                        "write all of its numbers with points or all with commas");
        if (same == nullptr) same = &c;
        found.may_be_1000 = found.may_be_1000 && v->may_be_1000;
        return v->value;
    }
    /// In a comma-separated table "1,234" may be 1.234 or 1234 if no other comma of its column tells.
    void check_thousands() const
    {
        for (auto const& [where, found] : decimals_)
            if (found.comma != nullptr && found.may_be_1000 && t_.separators[std::size_t(where.first)] == ',')
                refuse_cell(*found.comma, t_.columns[std::size_t(where.second)],
                            "it may have a decimal comma, or one between thousands",
                            "write numbers with a decimal point, and nothing between thousands");
    }
    bool flag(Row const& row, std::string const& role)
    {
        if (is_button(row, role)) ++buttons_[role];
        std::string const text = lower_case(cell(row, role).text);
        // Spreadsheets write them in their own language.
        for (char const* yes : {"1", "1.0", "1,0", "true", "yes", "wahr", "vrai", "verdadero", "vero", "waar"})
            if (text == yes) return true;
        for (char const* no : {"0", "0.0", "0,0", "false", "no", "falsch", "faux", "falso", "onwaar"})
            if (text == no) return false;
        auto const number = read_decimal(text);
        refuse_cell(cell(row, role), roles_.column.at(role), fmt::format("'{}' is 1 or 0", role),
                    number && is_missing_code(number->value)
                        ? fmt::format("use 1 and 0, or --missing {} if nothing was answered", text)
                        : "use 1 and 0, true and false, or yes and no");
    }
    int count(Row const& row, std::string const& role)
    {
        double const v = number(row, role);
        if (v < 0 || v != std::floor(v))
            refuse_cell(cell(row, role), roles_.column.at(role), fmt::format("'{}' is a number of trials", role),
                        "use a whole number from 0 up");
        if (v > kMostImportedTrials)
            refuse_cell(cell(row, role), roles_.column.at(role),
                        fmt::format("'{}' is at most {} trials", role, kMostImportedTrials),
                        "analyse parts of the trials");
        return int(v);
    }

    bool has_signals_and_correct() const { return has("signal") && (has("correct") || has("correct_count")); }
    Task task() const
    {
        if (roles_.task) return *roles_.task;
        if (has("first") || has("second")) return Task::pair;
        if (has("yes") || has("yes_count") || has_signals_and_correct()) return Task::yes_no;
        if (has("level")) return Task::two_interval;
        if (has("value")) return Task::rating;
        if (has("correct") || has("correct_count")) return Task::two_interval;
        refuse_roles("it is unknown what these trials are",
                     "name first and second with chosen, value, or level with correct: roles are " +
                         known_roles());
    }
    /// Answers of yes_no are given as yes and no, or by whether they are correct, of known signals.
    bool says_yes() const
    {
        return made_.task == Task::yes_no && (has("yes") || has("yes_count") || !has_signals_and_correct());
    }
    /// Which columns must not be empty.
    void check_roles()
    {
        auto const need = [&](std::string const& role) {
            if (!has(role))
                refuse_roles(fmt::format("a column for '{}' is missing", role),
                             fmt::format("add {}=COLUMN to --columns", role));
            needed_.push_back(role);
        };
        if (has("participant")) needed_.emplace_back("participant");
        if (made_.task == Task::pair || made_.task == Task::pair_with_reference) {
            need("first");
            need("second");
            std::string both;
            for (char const* role : {"first_wins", "first_chosen", "chosen_from_0", "chosen"})
                if (has(role)) both += (both.empty() ? "'" : " and '") + std::string(role) + "'";
            if (both.find(" and ") != std::string::npos)
                throw ScriptError(t_.file, {}, "columns for " + both, "each of them tells the choice",
                                  "name one of them");
            if (has("first_wins")) {
                made_.detail = TrialDetail::counts;
                need("first_wins");
                need("second_wins");
            } else
                need(has("first_chosen") ? "first_chosen" : has("chosen_from_0") ? "chosen_from_0" : "chosen");
            return;
        }
        if (made_.task == Task::rating || made_.task == Task::magnitude || made_.task == Task::adjustment) {
            need("value");
            if (has("item")) need("item");
            if (!has("item") && factors_.empty()) refuse_roles("nothing says what was judged", "name item=COLUMN");
            return;
        }
        if ((has("yes") || has("yes_count")) && (has("correct") || has("correct_count")))
            throw ScriptError(t_.file, {}, "columns for both 'yes' and 'correct'", "each of them tells the answer",
                              "name one of them");
        bool const is_yes = says_yes();
        if (made_.task == Task::ranking || made_.task == Task::questionnaire || made_.task == Task::free_walk)
            throw ScriptError(
                t_.file, {}, fmt::format("task '{}'", study::facts(made_.task).name),
                "tables of such trials are not read",
                "use pair, rating, magnitude, adjustment, 2ifc, abx, oddity, same_different or yes_no");
        std::string const hits = is_yes ? "yes_count" : "correct_count",
                          rest = is_yes ? "no_count" : "wrong_count";
        if (has("level")) need("level");
        if (has("percent") || has(hits)) made_.detail = TrialDetail::counts;
        if (has("percent")) {
            need("percent");
            need("trials");
        } else if (has(hits)) {
            need(hits);
            need(has(rest) ? rest : "trials");
        } else
            need(is_yes ? "yes" : "correct");
        bool const has_two_kinds = made_.task == Task::same_different || made_.task == Task::abx ||
                                   (made_.task == Task::yes_no && !has("level"));
        if (has_two_kinds) need("signal");
    }

    std::vector<std::size_t> columns_of_code(std::string const& column) const
    {
        if (!column.empty()) return {std::size_t(column_of(column, "--missing names it"))};
        std::vector<std::size_t> all;
        for (char const* role : {"value", "level", "signal", "correct", "yes", "trials", "correct_count",
                                 "wrong_count", "yes_count", "no_count", "percent", "reaction_s", "reaction_ms",
                                 "first_chosen", "chosen_from_0", "chosen", "first_wins", "second_wins", "ties"})
            if (has(role)) all.push_back(std::size_t(at_.at(role)));
        return all;
    }
    /// The code of --missing that the cell is; null = none.
    Code* code_of(Row const& row, std::size_t column)
    {
        std::string const& text = row[column].text;
        for (Code& code : codes_) {
            if (std::find(code.columns.begin(), code.columns.end(), column) == code.columns.end()) continue;
            auto const a = read_decimal(text), b = read_decimal(code.text);
            if (text != code.text && !(a && b && a->value == b->value)) continue;
            code.is_found = true;
            return &code;
        }
        return nullptr;
    }
    bool is_missing(Row const& row, std::size_t column)
    {
        return DelimitedText::is_missing(row[column].text) || code_of(row, column) != nullptr;
    }

    bool is_used(Row const& row)
    {
        for (auto const& [column, value] : roles_.only)
            if (row[std::size_t(t_.column(column))].text != value) {
                ++left_out_[fmt::format("'{}' is not {}", column, value)];
                return false;
            }
        auto const is_there = [&](std::size_t column) {
            if (!is_missing(row, column)) return true;
            Code const* const code = code_of(row, column);
            ++left_out_[code != nullptr ? fmt::format("'{}' is {}", t_.columns[column], code->text)
                                        : fmt::format("no '{}'", t_.columns[column])];
            return false;
        };
        for (std::string const& role : needed_)
            for (std::size_t const column : parts_.at(role))
                if (!is_there(column)) return false;
        for (int const f : factors_)
            if (!is_there(std::size_t(f))) return false;
        return true;
    }

    void read(Row const& row)
    {
        if (!is_used(row)) return;
        MadeTrial m;
        m.participant = has("participant") ? name(row, "participant") : "all";
        if (has("run")) m.run = name(row, "run");
        used_.push_back(&row);
        ids_.push_back(m.participant);
        for (int const f : factors_) m.factors.push_back(row[std::size_t(f)].text);
        for (auto const& [role, unit_ms] : {std::pair("reaction_ms", 1.0), std::pair("reaction_s", 1000.0)}) {
            if (m.reaction_ms || !has(role)) continue;
            if (is_missing(row, std::size_t(at_.at(role)))) {
                if (Code const* const code = code_of(row, std::size_t(at_.at(role))))
                    ++left_out_times_[fmt::format("'{}' is {}", roles_.column.at(role), code->text)];
                continue;
            }
            m.reaction_ms = unit_ms * number(row, role);
            reactions_[role].push_back(*m.reaction_ms);
            if (*m.reaction_ms < 0)
                refuse_cell(cell(row, role), roles_.column.at(role), "no reaction time is below 0",
                            fmt::format("leave the cell empty if there was none, or use --missing {}",
                                        cell(row, role).text));
        }
        switch (made_.task) {
        case Task::pair:
        case Task::pair_with_reference:
            return read_pair(row, m);
        case Task::rating:
        case Task::magnitude:
        case Task::adjustment:
            return read_value(row, m);
        default:
            read_answer(row, m);
        }
    }

    void add(MadeTrial const& m, int times)
    {
        if (int(made_.trials.size()) + times > kMostImportedTrials)
            throw ScriptError(t_.file, {}, fmt::format("more than {} trials", kMostImportedTrials),
                              "counts are read as single trials", "analyse parts of the table");
        made_.trials.insert(made_.trials.end(), std::size_t(times), m);
    }

    void read_pair(Row const& row, MadeTrial& m)
    {
        m.items = {cell(row, "first").text, cell(row, "second").text};
        if (m.items[0] == m.items[1])
            refuse_cell(cell(row, "second"), roles_.column.at("second"), "the same item is first and second",
                        "leave such rows out: they say nothing of scores");
        auto const answered = [&](char const* answer, int times) {
            m.response = answer;
            add(m, times);
        };
        if (has("first_wins")) {
            answered("first", count(row, "first_wins"));
            answered("second", count(row, "second_wins"));
            if (has("ties")) answered("neither", count(row, "ties"));
            return;
        }
        if (has("first_chosen")) {
            std::string const& text = cell(row, "first_chosen").text;
            if (text == "0.5" || text == "0,5") return answered("neither", 1);
            return answered(flag(row, "first_chosen") ? "first" : "second", 1);
        }
        bool const is_from_0 = !has("chosen") || has("chosen_from_0");
        TextCell const& c = cell(row, is_from_0 ? "chosen_from_0" : "chosen");
        std::string const text = lower_case(c.text);
        auto const is = [&](std::initializer_list<char const*> words) {
            return std::any_of(words.begin(), words.end(), [&](char const* w) { return text == w; });
        };
        std::optional<int> const position = position_of(c.text);
        if (is_from_0 && position && *position < 2) return answered(*position == 0 ? "first" : "second", 1);
        if (is_from_0 && position)
            refuse_cell(c, roles_.column.at("chosen_from_0"), "the positions of two are 0 and 1, counted from 0",
                        "write neither if it means that there was no difference, or leave such rows out");
        char const* const as_name = c.text == m.items[0] ? "first" : c.text == m.items[1] ? "second" : nullptr;
        char const* const as_word = is({"first", "left"}) || position == 1            ? "first"
                                    : is({"second", "right"}) || position == 2        ? "second"
                                    : is({"neither", "tie", "equal", "same", "none"}) ? "neither"
                                    : position == 0                                   ? "position 0"
                                                                                      : nullptr;
        if (as_name != nullptr && as_word == nullptr) is_chosen_by_name_ = true;
        if (as_name != nullptr && as_word != nullptr && std::string_view(as_name) != as_word) ++as_names_[c.text];
        if (as_name == nullptr && as_word != nullptr) ++as_words_[c.text];
        if (as_name == nullptr && position)
            positions_.push_back({made_.trials.size(), &c, *position, is_button(row, "chosen")});
        if (as_name != nullptr || as_word != nullptr) return answered(as_name != nullptr ? as_name : as_word, 1);
        refuse_cell(
            c, roles_.column.at(is_from_0 ? "chosen_from_0" : "chosen"),
            fmt::format("it is neither '{}' nor '{}', nor first, second or neither", m.items[0], m.items[1]),
            "name the chosen item, or write first, second or neither");
    }

    /// Whether the cell is the response to a trial with buttons of jsPsych: their numbers begin at 0 ("button_pressed" before
    /// version 7; https://www.jspsych.org/latest/plugins/html-button-response).
    bool is_button(Row const& row, std::string const& role) const
    {
        std::string const& column = roles_.column.at(role);
        int const type = t_.column("trial_type");
        return type >= 0 && (column == "response" || column == "button_pressed") &&
               row[std::size_t(type)].text.ends_with("button-response") && position_of(cell(row, role).text);
    }

    /// Answers by position count from 1, or from 0 if the program that wrote them is known to do so. Elsewhere a 0 is refused,
    /// since 0 and 1 may also be flags of "the first was chosen", which mean the opposite.
    void resolve_positions()
    {
        if (positions_.empty()) return;
        Position const *zero = nullptr, *two = nullptr;
        bool are_buttons = true;
        for (Position const& p : positions_) {
            if (p.number == 0 && zero == nullptr) zero = &p;
            if (p.number == 2 && two == nullptr) two = &p;
            are_buttons = are_buttons && p.is_button;
        }
        std::string const& column = roles_.column.at("chosen");
        if (zero != nullptr && two != nullptr)
            refuse_cell(
                *zero->cell, column,
                fmt::format("the column has 2, too (line {}): 0 may be the first of three buttons, or no choice",
                            two->cell->place.line),
                "write first, second and neither, or leave rows without a choice empty");
        if (zero != nullptr && !are_buttons)
            refuse_cell(
                *zero->cell, column,
                "0 and 1 may be positions counted from 0, or 1 may mean that the first was chosen: these are "
                "opposites",
                fmt::format("use chosen_from_0={0} if 0 means that the first was chosen, first_chosen={0} if 1 "
                            "does",
                            column));
        bool const from_0 = zero != nullptr || (are_buttons && two == nullptr);
        if (from_0)
            for (Position const& p : positions_)
                made_.trials[p.trial].response = p.number == 0 ? "first" : "second";
        if (from_0)
            made_.notes.push_back(
                fmt::format("column '{}' has numbers of jsPsych's buttons, which count from 0: 0 is read as "
                            "first, 1 as second ({} rows)",
                            column, positions_.size()));
        else if (two == nullptr && positions_.size() == made_.trials.size())
            made_.notes.push_back(
                fmt::format("answers in column '{0}' that are positions are all 1 ({1} rows): they are read "
                            "as first; use chosen_from_0={0} if they count from 0",
                            column, positions_.size()));
    }

    /// A caution if numbers of buttons are read as 1 = yes: the button 0 may be the one of yes.
    void note_buttons()
    {
        for (auto const& [role, n] : buttons_)
            made_.notes.push_back(fmt::format(
                "column '{0}' has numbers of jsPsych's buttons, which count from 0: {1}={0} reads 1, the second "
                "button, as "
                "yes ({2} rows){3}",
                roles_.column.at(role), role, n,
                role == "first_chosen" ? fmt::format("; if button 0 is that of the first, use chosen_from_0={}",
                                                     roles_.column.at(role))
                                       : "; if button 0 is that of yes, exchange 0 and 1"));
    }

    /// Cautions on numbers that look like codes of missing values, on codes that do not occur, and the times left out.
    void note_codes()
    {
        for (auto const& [why, n] : left_out_times_)
            made_.notes.push_back(fmt::format("{} reaction times left out: {}", n, why));
        for (Code const& code : codes_)
            if (!code.is_found) made_.notes.push_back(fmt::format("--missing {}: no cell has it", code.text));
        auto const doubt = [&](std::vector<double> const& numbers, NumberKind kind, std::string const& column,
                               std::string const& option) {
            for (MissingCode const& c : missing_codes(numbers, kind))
                made_.notes.push_back(
                    missing_code_caution(column, c, fmt::format("--missing {}{}", option, c.code)));
        };
        bool const is_judged = roles_.scale == Scale::linear && made_.task == Task::rating;
        for (auto const& [role, kind] :
             {std::pair("value", is_judged ? NumberKind::judgements : NumberKind::ratios),
              std::pair("level", NumberKind::ratios), std::pair("reaction_s", NumberKind::times),
              std::pair("reaction_ms", NumberKind::times)})
            if (numbers_.contains(role)) doubt(numbers_.at(role), kind, roles_.column.at(role), "");
        for (int const f : factors_) {
            std::vector<double> levels;
            for (Row const* row : used_)
                if (auto const v = read_decimal((*row)[std::size_t(f)].text)) levels.push_back(v->value);
            std::string const& column = t_.columns[std::size_t(f)];
            if (levels.size() == used_.size()) doubt(levels, NumberKind::ratios, column, column + "=");
        }
    }

    /// A caution if ids are in several files that have several participants each: each file may number its own people.
    void note_files()
    {
        std::map<int, std::set<std::string>> people;
        std::map<std::string, std::set<int>> files;
        for (std::size_t r = 0; r < used_.size(); ++r) {
            people[used_[r]->front().file].insert(ids_[r]);
            files[ids_[r]].insert(used_[r]->front().file);
        }
        if (!has("participant") || people.size() < 2) return;
        std::vector<std::string> shared;
        for (auto const& [id, in] : files)
            if (in.size() > 1 && std::all_of(in.begin(), in.end(), [&](int f) { return people[f].size() > 1; }))
                shared.push_back(id);
        if (shared.empty()) return;
        made_.notes.push_back(fmt::format("{} of {} ids ({}) are in several files: they are taken as the same "
                                          "people; if each file numbers its own, use "
                                          "participant=file+{}",
                                          shared.size(), files.size(), named_few(shared),
                                          roles_.column.at("participant")));
    }

    /// A caution if reaction times seem to be in another unit: their median is beyond half a minute, or below what people
    /// can do (simple reactions take 200 ms).
    void note_reaction_unit()
    {
        constexpr double kMost_ms = 30'000, kLeast_ms = 20;
        for (auto const& [role, ms] : reactions_) {
            double const median = gi::quantile(ms, 0.5);
            bool const is_seconds = role == "reaction_s";
            if (is_seconds ? !(median > kMost_ms) : !(median < kLeast_ms)) continue;
            made_.notes.push_back(fmt::format("reaction times in column '{}' have a median of {:g} ms: they seem "
                                              "to be in {}, which {}={} would say",
                                              roles_.column.at(role), median,
                                              is_seconds ? "milliseconds" : "seconds",
                                              is_seconds ? "reaction_ms" : "reaction_s", roles_.column.at(role)));
        }
    }

    /// A caution if answers may mean items or positions: items named 1, 2, 3 and `chosen` 1 or 2.
    void note_ambiguous_choices()
    {
        std::set<std::string> items;
        if (!as_words_.empty())
            for (MadeTrial const& t : made_.trials) items.insert(t.items.begin(), t.items.end());
        std::map<std::string, int> doubtful;
        if (!is_chosen_by_name_) doubtful = as_names_;
        for (auto const& [text, n] : as_words_)
            if (items.contains(text)) doubtful[text] += n;
        for (auto const& [text, n] : doubtful)
            made_.notes.push_back(
                fmt::format("answer '{}' ({} of {} rows) may name an item, a position or a tie: it is read as the "
                            "item if the pair has one of that name; write first, second or neither for positions",
                            text, n, t_.rows.size()));
    }

    void read_value(Row const& row, MadeTrial& m)
    {
        if (has("item")) m.items = {cell(row, "item").text};
        m.value = number(row, "value");
        if (std::abs(*m.value) > kLargestValue)
            refuse_cell(cell(row, "value"), roles_.column.at("value"), "values are from -1e15 to 1e15",
                        "leave such rows out, or use another unit");
        if (made_.task == Task::magnitude && !(*m.value > 0))
            refuse_cell(cell(row, "value"), roles_.column.at("value"), "magnitudes are above 0",
                        "leave such rows out, or use --task rating");
        m.response = "confirm";
        add(m, 1);
    }

    void read_answer(Row const& row, MadeTrial& m)
    {
        bool const is_yes = says_yes(), is_yes_no = made_.task == Task::yes_no;
        if (has("level")) {
            m.level = number(row, "level");
            if (std::abs(*m.level) > kLargestValue)
                refuse_cell(cell(row, "level"), roles_.column.at("level"), "levels are from -1e15 to 1e15",
                            "leave such rows out, or use another unit");
            if (roles_.scale != Scale::linear && !(*m.level > 0)) {
                if (!has("signal") || flag(row, "signal"))
                    refuse_cell(cell(row, "level"), roles_.column.at("level"), "it has no logarithm",
                                "use --scale linear, or leave such rows out");
                m.level.reset();
            }
        }
        m.is_signal = !has("signal") || flag(row, "signal");
        int hits = 0, rest = 0; // yes or correct; the others
        std::string const role = is_yes ? "yes" : "correct", other = is_yes ? "no" : "wrong";
        if (has("percent")) {
            double const percent = number(row, "percent"), share = percent / 100;
            if (share < 0 || share > 1)
                refuse_cell(cell(row, "percent"), roles_.column.at("percent"), "it is from 0 to 100",
                            "use correct_count or yes_count for numbers of trials");
            most_percent_ = std::max(most_percent_, percent);
            if (percent > 0 && percent < 1 && fraction_ == nullptr) fraction_ = &cell(row, "percent");
            int const n = count(row, "trials");
            hits = int(std::lround(share * n));
            // Published percentages are often rounded, or means of sessions of other lengths.
            rounded_ += std::abs(share * n - hits) > 0.0051 * n;
            rest = n - hits;
        } else if (has(role + "_count")) {
            hits = count(row, role + "_count");
            rest = has(other + "_count") ? count(row, other + "_count") : count(row, "trials") - hits;
            if (rest < 0)
                refuse_cell(cell(row, role + "_count"), roles_.column.at(role + "_count"),
                            fmt::format("it is more than the {} trials", count(row, "trials")), "check the table");
        } else
            (flag(row, role) ? hits : rest) = 1;
        for (bool const hit : {true, false}) {
            m.is_correct = is_yes ? hit == m.is_signal : hit;
            if (is_yes_no)
                m.response = *m.is_correct == m.is_signal ? "yes" : "no";
            else
                m.response = hit ? "correct" : "wrong";
            add(m, hit ? hits : rest);
        }
    }

    void check_percent() const
    {
        if (fraction_ != nullptr && most_percent_ <= 1)
            refuse_cell(*fraction_, roles_.column.at("percent"),
                        "percentages are from 0 to 100, and none is above 1",
                        "multiply fractions by 100, or use correct_count or yes_count");
    }

    void read_matrix()
    {
        if (!roles_.factors.empty() || !roles_.column.empty() || !roles_.only.empty())
            throw ScriptError(t_.file, {}, "--matrix with --columns, --factors or --only",
                              "a matrix has no columns but its items", "leave them out");
        for (std::string const& name : t_.columns) t_.check_one_column(name);
        made_.task = Task::pair;
        made_.detail = TrialDetail::wins;
        std::vector<std::string> const items(t_.columns.begin() + 1, t_.columns.end());
        for (auto const& row : t_.rows) {
            auto const own = std::find(items.begin(), items.end(), row[0].text);
            if (own == items.end())
                refuse_cell(row[0], t_.columns[0], "no column has this name",
                            "a matrix names its items in the first row and the first column");
            for (std::size_t j = 0; j < items.size(); ++j) {
                TextCell const& c = row[j + 1];
                auto const wins = gi::parse_number<int>(c.text);
                bool const is_self = items[j] == row[0].text;
                if (is_self && (c.text.empty() || c.text == "0" || DelimitedText::is_missing(c.text))) continue;
                if (!wins || *wins < 0 || is_self)
                    refuse_cell(c, items[j],
                                is_self ? "an item is compared with itself" : "it is a number of choices",
                                "use whole numbers from 0 up, and 0 on the diagonal");
                MadeTrial m;
                m.participant = "all";
                m.items = {row[0].text, items[j]};
                m.response = "first";
                add(m, *wins);
            }
        }
        made_.notes.emplace_back("a matrix does not say who chose, nor in which order: errors are those of "
                                 "independent choices, order and agreement are not analysed");
    }

    std::string notes_of_rows() const
    {
        std::string out = fmt::format("the table has {} rows", t_.rows.size());
        for (auto const& [why, n] : left_out_) out += fmt::format("; {} left out: {}", n, why);
        return out;
    }

    DelimitedText const& t_;
    ColumnRoles const& roles_;
    std::map<std::string, int> at_; ///< column by role, the first one
    std::map<std::string, std::vector<std::size_t>> parts_;
    std::vector<Code> codes_;
    std::vector<Row const*> used_; ///< rows that are not left out, with the ids of their participants
    std::vector<std::string> ids_;
    std::vector<Position> positions_;
    std::map<std::string, int> buttons_; ///< numbers of buttons that are read as flags, by role
    std::map<std::string, int> left_out_times_;
    std::map<std::string, std::vector<double>> numbers_; ///< by role
    std::vector<int> factors_;
    std::vector<std::string> needed_;
    std::map<std::string, int> left_out_;
    int rounded_ = 0;
    std::map<std::string, int> as_names_; ///< answers that name an item of the pair, and another position
    std::map<std::string, int> as_words_; ///< answers that are read as positions or ties
    bool is_chosen_by_name_ = false;      ///< an answer is certainly the name of an item
    /// How decimals are marked in a column of a file.
    struct Decimals {
        TextCell const *point = nullptr, *comma = nullptr; ///< the first cell with it
        bool may_be_1000 = true;                           ///< all commas may be between thousands
    };
    std::map<std::pair<int, int>, Decimals> decimals_;     ///< by file and column
    std::map<std::string, std::vector<double>> reactions_; ///< in ms by role
    TextCell const* fraction_ = nullptr;                   ///< the first percentage between 0 and 1
    double most_percent_ = 0;
    MadeExperiment made_;
};

} // namespace

std::map<std::string, std::string> parse_roles(std::string const& text)
{
    std::map<std::string, std::string> roles;
    std::size_t at = 0;
    while (at < text.size()) {
        std::size_t const end = std::min(text.find(',', at), text.size());
        std::string const part = text.substr(at, end - at);
        at = end + 1;
        auto const blank = part.find_first_not_of(' ');
        if (blank == std::string::npos) continue;
        auto const equals = part.find('=');
        std::string const role = part.substr(blank, equals == std::string::npos ? equals : equals - blank);
        if (equals == std::string::npos || equals + 1 >= part.size())
            throw ScriptError("--columns", {}, fmt::format("'{}'", part), "each is ROLE=COLUMN",
                              "use for example participant=observer,first=condition_a");
        if (std::find(std::begin(kRoles), std::end(kRoles), role) == std::end(kRoles))
            throw ScriptError("--columns", {}, fmt::format("role '{}'", role), "there is no such role",
                              "roles are " + known_roles() + "; conditions are named by --factors");
        if (!roles.emplace(role, part.substr(equals + 1)).second)
            throw ScriptError("--columns", {}, fmt::format("'{}' is given twice", role), "a role has one column",
                              "remove one");
    }
    return roles;
}

ImportedTable import_trials(DelimitedText const& table, ColumnRoles const& roles)
{
    bool names_files = std::find(roles.factors.begin(), roles.factors.end(), "file") != roles.factors.end();
    for (auto const& [role, column] : roles.column)
        for (std::string const& part : parts_of(table, role, column)) names_files = names_files || part == "file";
    if (!names_files || table.column("file") >= 0) return Importer(table, roles).import();
    DelimitedText const named = with_file_names(table);
    return Importer(named, roles).import();
}

} // namespace study
