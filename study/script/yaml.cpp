#include "study/script/yaml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <sstream>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>

namespace study {
namespace {

constexpr std::size_t kLongest = std::size_t(1) << 20; ///< the parser takes up to 300 times as much memory
constexpr int kDeepest = 60;

/// The parser calls itself for every level and every alias; this is counted before it starts.
void check_shape(std::string const& text, std::string const& file)
{
    int flow = 0, marks = 0, indent = 0;
    std::size_t aliases = 0;
    bool at_start = true;
    std::vector<int> indents;
    std::string why;
    if (text.size() > kLongest) why = "it is larger than 1 MiB";
    for (char const c : text) {
        if (c == '\n') {
            at_start = true;
            indent = marks = 0;
            continue;
        }
        flow += (c == '[' || c == '{') - ((c == ']' || c == '}') && flow > 0);
        if (at_start && (c == ' ' || c == '\t')) {
            ++indent;
            continue;
        }
        marks += c == '-' || c == '?' || c == ':';
        aliases += c == '*';
        if (at_start) {
            at_start = false;
            while (!indents.empty() && indents.back() >= indent) indents.pop_back();
            indents.push_back(indent);
        }
        if (flow > kDeepest || marks > 50 * kDeepest || int(indents.size()) > kDeepest)
            why = fmt::format("it nests deeper than {} levels", kDeepest);
        if (aliases > 1000) why = "it has more than 1000 '*'";
        if (!why.empty()) break;
    }
    if (!why.empty()) throw ScriptError(file, {1, 1}, "this YAML is not read", why, "scripts are small and flat");
}

/// Keeps where the last document begins.
class DocumentStart : public YAML::EventHandler {
public:
    YAML::Mark mark;

    void OnDocumentStart(YAML::Mark const& at) override { mark = at; }
    void OnDocumentEnd() override {}
    void OnNull(YAML::Mark const&, YAML::anchor_t) override {}
    void OnAlias(YAML::Mark const&, YAML::anchor_t) override {}
    void OnScalar(YAML::Mark const&, std::string const&, YAML::anchor_t, std::string const&) override {}
    void OnSequenceStart(YAML::Mark const&, std::string const&, YAML::anchor_t, YAML::EmitterStyle::value) override
    {
    }
    void OnSequenceEnd() override {}
    void OnMapStart(YAML::Mark const&, std::string const&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
    void OnMapEnd() override {}
};

/// What Load would leave unread, without LoadAll: that goes on for ever at a comma of its own.
void check_one_document(std::string const& text, std::string const& file)
{
    std::istringstream in(text);
    YAML::Parser parser(in);
    DocumentStart second;
    if (parser.HandleNextDocument(second) && parser.HandleNextDocument(second))
        throw ScriptError(file, {second.mark.line + 1, second.mark.column + 1}, "a second document begins here",
                          "it would be ignored", "one file has one: check the indentation, or remove it");
}

/// Insertions, deletions, replacements and exchanges of neighbours (optimal string alignment).
int edit_distance(std::string const& a, std::string const& b)
{
    std::vector<int> before, above(b.size() + 1), row(b.size() + 1);
    std::iota(above.begin(), above.end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = int(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = above;
        above = row;
    }
    return above.back();
}

/// "did you mean 'x'?", or all that there are.
std::string suggest(std::string const& name, std::vector<std::string> const& known)
{
    std::string all;
    std::string const* nearest = nullptr;
    int least = std::max(1, int(name.size()) / 2) + 1;
    for (std::size_t i = 0; i < known.size(); ++i) {
        int const distance = edit_distance(known[i], name);
        if (distance < least) {
            least = distance;
            nearest = &known[i];
        }
        if (i < 24) all += (i ? ", " : "") + known[i];
    }
    if (nearest != nullptr) return "did you mean '" + *nearest + "'?";
    return known.empty() ? "remove it" : "there are: " + all;
}

} // namespace

Yaml Yaml::parse(std::string const& text, std::string const& file, std::string const& what)
{
    check_shape(text, file);
    try {
        check_one_document(text, file);
        return {YAML::Load(text), file, what};
    } catch (YAML::Exception const& e) {
        throw ScriptError(file, {e.mark.line + 1, e.mark.column + 1}, "this is not YAML", e.msg,
                          "check the indentation and the quotes");
    }
}

Place Yaml::place() const
{
    YAML::Mark const mark = node_.Mark();
    return {mark.line + 1, mark.column + 1};
}

ScriptError Yaml::error(std::string const& problem, std::string const& why, std::string const& suggestion) const
{
    return {file_, place(), problem, why, suggestion};
}

ScriptError Yaml::unknown(std::string const& what, std::vector<std::string> const& known) const
{
    std::string const name = node_.IsScalar() ? node_.Scalar().substr(0, 64) : path_;
    return error(fmt::format("'{}' is no {}", name, what), "there is none of that name", suggest(name, known));
}

bool Yaml::has(std::string const& key) const { return node_.IsMap() && node_[key].IsDefined(); }

Yaml Yaml::at(std::string const& key) const
{
    return {has(key) ? node_[key] : YAML::Node(), file_, path_ + "." + key};
}

Yaml Yaml::needed(std::string const& key, std::string const& example) const
{
    if (!has(key))
        throw error(fmt::format("{} has no '{}'", path_, key), "it has no usual value",
                    fmt::format("write {}: {}", key, example));
    return at(key);
}

std::vector<std::pair<Yaml, Yaml>> Yaml::entries() const
{
    if (!node_.IsMap())
        throw error(path_ + " is not a map", "keys and values are needed here", "write key: value lines");
    std::set<std::string> seen;
    std::vector<std::pair<Yaml, Yaml>> out;
    for (auto const& entry : node_) {
        Yaml const key(entry.first, file_, path_);
        if (!entry.first.IsScalar()) throw key.error("a key is not text", "it is a list or a map", "name it");
        std::string const name = entry.first.Scalar().substr(0, 64);
        if (!seen.insert(name).second)
            throw key.error(fmt::format("key '{}' twice in {}", name, path_), "only one of them can count",
                            "remove one");
        if (entry.second.IsNull())
            throw key.error(fmt::format("key '{}' in {} has no value", name, path_), "it would be ignored",
                            "give it one or remove it");
        out.emplace_back(key, Yaml(entry.second, file_, path_ + "." + name));
    }
    return out;
}

void Yaml::only_keys(std::set<std::string> const& known) const
{
    for (auto const& [key, unused] : entries()) {
        std::string const name = key.node_.Scalar().substr(0, 64);
        if (!known.contains(name))
            throw key.error(fmt::format("unknown key '{}' in {}", name, path_), "it would be ignored",
                            suggest(name, {known.begin(), known.end()}));
    }
}

std::vector<Yaml> Yaml::items() const
{
    if (!node_.IsSequence())
        throw error(path_ + " is not a list", "a list is needed here",
                    "write [a, b] or lines that start with '- '");
    std::vector<Yaml> out;
    for (std::size_t i = 0; i < node_.size(); ++i)
        out.emplace_back(node_[i], file_, fmt::format("{}[{}]", path_, i));
    return out;
}

std::vector<Yaml> Yaml::one_or_more() const { return is_list() ? items() : std::vector<Yaml>{*this}; }

double Yaml::number(double low, double high) const
{
    double v = 0;
    if (node_.IsScalar()) {
        std::string const& s = node_.Scalar();
        char const* const begin = s.data() + (s.starts_with('+') ? 1 : 0);
        auto const [end, failure] = std::from_chars(begin, s.data() + s.size(), v);
        if (failure == std::errc{} && end == s.data() + s.size() && begin != end) {
            if (v >= low && v <= high) return v;
            throw error(fmt::format("{} is {}", path_, s.substr(0, 64)),
                        fmt::format("it must lie between {:g} and {:g}", low, high), "change it");
        }
    }
    throw error(path_ + " is not a number", "a number is needed here", "write 1 or 0.5");
}

int Yaml::integer(int low, int high) const
{
    double const v = number(low, high);
    if (v != std::floor(v)) throw error(path_ + " is not whole", "a whole number is needed here", "round it");
    return int(v);
}

std::uint64_t Yaml::seed() const
{
    std::uint64_t v = 0;
    std::string const s = text();
    auto const [end, failure] = std::from_chars(s.data(), s.data() + s.size(), v);
    if (failure != std::errc{} || end != s.data() + s.size())
        throw error(path_ + " is no seed", "it is a whole number from 0 to 2^64 - 1", "write 20261");
    return v;
}

bool Yaml::boolean() const
{
    if (node_.IsScalar() && (node_.Scalar() == "true" || node_.Scalar() == "false"))
        return node_.Scalar() == "true";
    throw error(path_ + " is neither true nor false", "one of them is needed here", "write true or false");
}

std::string Yaml::text() const
{
    if (!node_.IsScalar()) throw error(path_ + " is not text", "text is needed here", "put it in quotes");
    return node_.Scalar();
}

std::string Yaml::name() const
{
    std::string const s = text();
    bool const is_name = !s.empty() && s.size() <= 64 && std::all_of(s.begin(), s.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '.' || c == '+' || c == '-';
    });
    if (!is_name)
        throw error(fmt::format("'{}' is no name", s.substr(0, 64)),
                    "names stand in tables: 1 to 64 letters, digits and _ . + -", "choose another");
    return s;
}

int Yaml::one_of(std::vector<std::string> const& words, std::string const& what) const
{
    std::string const s = text();
    auto const found = std::find(words.begin(), words.end(), s);
    if (found == words.end()) throw unknown(what, words);
    return int(found - words.begin());
}

} // namespace study
