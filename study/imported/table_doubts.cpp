#include "study/imported/table_doubts.h"

#include "gi/core/text.h"
#include "study/imported/decimal_number.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <set>

namespace study {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Without case, blanks, zeros before a number, and ".0" after a whole one.
std::string folded(std::string const& name)
{
    // Blanks of other programs in UTF-8: no-break space, narrow and zero-width ones.
    std::string text = name;
    for (std::string_view const blank : {"\xc2\xa0", "\xe2\x80\xaf", "\xe2\x80\x8b", "\xef\xbb\xbf", " ", "\t"})
        for (std::size_t at; (at = text.find(blank)) != std::string::npos;) text.erase(at, blank.size());
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        auto c = static_cast<unsigned char>(text[i]);
        if (c >= 'A' && c <= 'Z') c = static_cast<unsigned char>(c - 'A' + 'a');
        // Capitals of Latin-1, such as U+00C9, but not the sign of multiplication.
        bool const is_latin = !out.empty() && static_cast<unsigned char>(out.back()) == 0xc3;
        if (is_latin && c >= 0x80 && c <= 0x9e && c != 0x97) c = static_cast<unsigned char>(c + 0x20);
        bool const begins =
            c == '0' && (out.empty() || (!is_digit(out.back()) && out.back() != '.' && out.back() != ','));
        if (begins && i + 1 < text.size() && is_digit(text[i + 1])) continue;
        out += char(c);
    }
    std::size_t const point = out.find('.');
    if (point != std::string::npos && point > 0 && point + 1 < out.size() &&
        out.find_first_not_of("0", point + 1) == std::string::npos &&
        std::all_of(out.begin(), out.begin() + std::ptrdiff_t(point), is_digit))
        out.resize(point);
    return out;
}

/// The whole numbers that follow each other by 1 from row to row, as row numbers do.
bool numbers_rows(std::vector<std::vector<TextCell> const*> const& rows, std::size_t column)
{
    std::optional<long> last;
    for (auto const* row : rows) {
        auto const v = gi::parse_number<long>((*row)[column].text);
        if (!v || (last && *v != *last + 1)) return false;
        last = v;
    }
    return rows.size() > 1;
}

/// How often all rows occur; 1 = there are rows that occur as often as no others.
int common_count(std::map<std::string, int> const& times)
{
    int common = 0;
    for (auto const& [unused, n] : times) common = std::gcd(common, n);
    return std::max(1, common);
}

constexpr double kCodes[] = {-1,     -8, -9, -77, -88, -99, -777, -888, -999, -7777, -8888, -9999,
                             -99999, 9,  77, 88,  99,  777, 888,  999,  7777, 8888,  9999,  99999};

struct Others {
    double low = INFINITY, high = -INFINITY;
    bool are_whole = true;

    void add(double v)
    {
        low = std::min(low, v);
        high = std::max(high, v);
        are_whole = are_whole && v == std::floor(v);
    }
    double range() const { return high - low; }
};

/// Whether the code cannot be one of these numbers.
bool is_far(double code, Others const& o, NumberKind kind)
{
    constexpr double kLeastLarge = 77; // smaller codes are easily numbers
    bool const is_large = std::abs(code) >= kLeastLarge, is_judged = kind == NumberKind::judgements;
    double const share = kind == NumberKind::times ? 2 : is_judged && o.are_whole ? 0.5 : 1;
    if (code < 0) {
        // Scales with zero in their middle have -1, and those without negative numbers have no code by chance.
        bool const is_positive = o.low >= 0 && (o.are_whole || o.low >= 1) && (code != -1 || o.high >= 4);
        if (o.low >= 0 && is_large) return true;
        return is_judged && (is_positive || (code != -1 && o.low - code > share * o.range()));
    }
    if (!(code - o.high > share * o.range())) return false;
    return kind != NumberKind::ratios || (is_large && (o.low <= 0 || code / o.high > o.high / o.low));
}

} // namespace

std::string named_few(std::vector<std::string> const& names, std::size_t most)
{
    std::size_t const n = std::min(names.size(), most);
    std::string const text = fmt::format("{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(n), ", "));
    return names.size() > n ? text + ", ..." : text;
}

std::vector<std::pair<std::string, std::string>> similar_names(std::vector<std::string> const& names)
{
    std::vector<std::pair<std::string, std::string>> pairs;
    std::map<std::string, std::string> first;
    for (std::string const& name : names) {
        auto const [it, is_new] = first.emplace(folded(name), name);
        if (!is_new && it->second != name) pairs.emplace_back(it->second, name);
    }
    return pairs;
}

std::string similar_names_caution(std::string const& what, std::vector<std::string> const& names)
{
    constexpr std::size_t kMostNamed = 5;
    auto const pairs = similar_names(names);
    if (pairs.empty()) return {};
    std::string list;
    for (std::size_t i = 0; i < std::min(pairs.size(), kMostNamed); ++i)
        list += fmt::format("{}'{}' and '{}'", i > 0 ? ", " : "", pairs[i].first, pairs[i].second);
    if (pairs.size() > kMostNamed) list += fmt::format(" and {} more pairs", pairs.size() - kMostNamed);
    return fmt::format(
        "{} {} differ only in case, blanks or zeros: they are taken as different; write what is the "
        "same in one way",
        what, list);
}

std::string repeated_rows_caution(std::vector<std::vector<TextCell> const*> const& rows,
                                  std::vector<std::string> const& participants)
{
    // So many different rows do not all repeat equally often by chance.
    constexpr std::size_t kLeastRows = 6, kLeastOfOne = 12;
    if (rows.empty()) return {};
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < rows[0]->size(); ++c)
        if (!numbers_rows(rows, c)) columns.push_back(c);
    std::map<std::string, int> all;
    std::map<std::string, std::map<std::string, int>> by_person;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        std::string key;
        for (std::size_t const c : columns) key += (*rows[r])[c].text + '\x1f';
        ++all[key];
        ++by_person[participants[r]][key];
    }
    if (int const n = common_count(all); n > 1 && all.size() >= kLeastRows)
        return fmt::format(
            "{} of {} rows are identical to an earlier one, and no row occurs less than {} times: if the table "
            "was joined with itself, its trials count {} times",
            rows.size() - all.size(), rows.size(), n, n);
    std::vector<std::string> who;
    std::size_t identical = 0;
    for (auto const& [person, times] : by_person)
        if (common_count(times) > 1 && times.size() >= kLeastOfOne) {
            who.push_back(person);
            for (auto const& [unused, n] : times) identical += std::size_t(n - 1);
        }
    if (who.empty()) return {};
    return fmt::format(
        "{} of {} rows are identical to an earlier one, among them each row of {} participant{} ({}): if "
        "these were joined twice, their trials count twice",
        identical, rows.size(), who.size(), who.size() == 1 ? "" : "s", named_few(who));
}

std::vector<MissingCode> missing_codes(std::vector<double> const& numbers, NumberKind kind)
{
    constexpr int kLeastOthers = 2;
    std::map<double, int> counts;
    for (double const v : numbers) ++counts[v];
    Others others;
    std::set<double> codes;
    for (auto const& [v, unused] : counts)
        if (is_missing_code(v))
            codes.insert(v);
        else
            others.add(v);
    if (counts.size() - codes.size() < kLeastOthers) return {};
    // A code near the others is one of them, and then so may be the next one.
    for (auto it = codes.begin(); it != codes.end();)
        if (is_far(*it, others, kind)) {
            ++it;
        } else {
            others.add(*it);
            codes.erase(it);
            it = codes.begin();
        }
    std::vector<MissingCode> found;
    for (double const c : codes) found.push_back({c, counts[c], others.low, others.high});
    return found;
}

bool is_missing_code(double v) { return std::find(std::begin(kCodes), std::end(kCodes), v) != std::end(kCodes); }

std::string missing_code_caution(std::string const& column, MissingCode const& code, std::string const& option)
{
    return fmt::format(
        "{} {} times in column '{}' is far from all others, which are from {:.6g} to {:.6g}: if it stands for a "
        "missing value, use {}",
        code.code, code.count, column, code.low, code.high, option);
}

bool names_people(std::string const& factor)
{
    std::string name;
    for (char const c : factor)
        if ((c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80)
            name += c;
        else if (c >= 'A' && c <= 'Z')
            name += char(c - 'A' + 'a');
    for (std::string_view const who :
         {"subject", "participant", "observer", "patient", "person", "between", "user"})
        if (name.size() > who.size() && name.starts_with(who)) name.erase(0, who.size());
    for (std::string_view const known :
         {"group",        "groups",     "age",       "agegroup",   "agegroups", "agerange", "sex",
          "gender",       "cohort",     "diagnosis", "handedness", "expertise", "gruppe",   "alter",
          "altersgruppe", "geschlecht", "groupe",    "sexe",       "grupo",     "sexo",     "edad"})
        if (name == known) return true;
    return false;
}

bool are_numbered(std::vector<std::string> const& ids)
{
    std::set<long> numbers;
    std::optional<std::string> prefix;
    for (std::string const& id : ids) {
        std::size_t begin = id.size();
        while (begin > 0 && is_digit(id[begin - 1])) --begin;
        std::string const own = folded(id.substr(0, begin));
        if (prefix && own != *prefix) return false;
        prefix = own;
        auto const number = gi::parse_number<long>(std::string_view(id).substr(begin));
        if (!number) return false;
        numbers.insert(*number);
    }
    return !numbers.empty() && *numbers.rbegin() - *numbers.begin() < 2 * long(numbers.size());
}

} // namespace study
