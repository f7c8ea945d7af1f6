#include "gi/core/yaml.h"

#include "gi/core/edit_distance.h"
#include "gi/core/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <sstream>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>

namespace gi {
namespace {

constexpr std::size_t kLongestYaml = std::size_t(1) << 20; ///< the parser takes up to 300 times as much memory
constexpr int kDeepestYaml = 100;

/// The parser calls itself for every level and every alias, so both are counted before it starts.
void check_shape(std::string const& text, std::string const& file)
{
    int flow = 0, marks = 0, indent = 0, aliases = 0;
    bool at_start = true;
    std::vector<int> indents;
    std::string why = text.size() > kLongestYaml ? "it is larger than 1 MiB" : "";
    for (char const c : text) {
        if (!why.empty()) break;
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
        if (flow > kDeepestYaml || marks > 50 * kDeepestYaml || int(indents.size()) > kDeepestYaml)
            why = fmt::format("it nests deeper than {} levels", kDeepestYaml);
        if (aliases > 1000) why = "it has more than 1000 '*'";
    }
    if (!why.empty())
        throw InputError(TextLocation{file, 1, 1}, "this YAML is not read", why, "such files are small and flat");
}

/// The parser takes any bytes, which tables and windows cannot show.
void check_characters(std::string const& text, std::string const& file)
{
    TextLocation where{file, 1, 1};
    for (std::size_t i = 0; i < text.size();) {
        std::size_t const bytes = first_character(std::string_view(text).substr(i));
        auto const c = static_cast<unsigned char>(text[i]);
        if (bytes == 0)
            throw InputError(where, fmt::format("the byte {:02x} is no UTF-8", c), "texts would be unreadable",
                             "save the file as UTF-8");
        if ((c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f)
            throw InputError(where, fmt::format("the control character {:02x}", c), "it cannot be seen",
                             "remove it");
        i += bytes;
        where.column = c == '\n' ? 1 : where.column + int(bytes);
        where.line += c == '\n';
    }
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

TextLocation location(std::string const& file, YAML::Mark const& mark)
{
    return {file, mark.line + 1, mark.column + 1};
}

/// What Load would leave unread, without LoadAll, which does not end at a comma by itself.
void check_one_document(std::string const& text, std::string const& file)
{
    std::istringstream in(text);
    YAML::Parser parser(in);
    DocumentStart second;
    if (parser.HandleNextDocument(second) && parser.HandleNextDocument(second))
        throw InputError(location(file, second.mark), "a second document begins here", "it would be ignored",
                         "one file has one: check the indentation, or remove it");
}

/// Throws if a line is indented by a tab, which is why a text is not YAML though it looks like it.
void check_indentation(std::string const& text, std::string const& file)
{
    std::istringstream in(text);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        std::size_t const begin = line.find_first_not_of(" \t"), tab = line.find('\t');
        if (begin != std::string::npos && tab < begin && line[begin] != '#')
            throw InputError(TextLocation{file, number, int(tab) + 1}, "this line is indented by a tab",
                             "YAML takes only blanks", "write blanks");
    }
}

std::string shortened(std::string const& s) { return s.substr(0, 64); }

} // namespace

Yaml Yaml::parse(std::string const& text, std::string const& file, std::string const& root)
{
    check_shape(text, file);
    check_characters(text, file);
    try {
        std::string readable = text;
        if (readable.starts_with("%YAML:1.0")) readable[5] = ' ';
        check_one_document(readable, file);
        return {YAML::Load(readable), file, root};
    } catch (YAML::Exception const& e) {
        check_indentation(text, file);
        throw InputError(location(file, e.mark), "this is not YAML", e.msg,
                         "check the indentation and the quotes");
    }
}

TextLocation Yaml::place() const { return location(file_, node_.Mark()); }

InputError Yaml::error(std::string const& problem, std::string const& why, std::string const& suggestion) const
{
    return {place(), problem, why, suggestion};
}

InputError Yaml::unknown(std::string const& what, std::vector<std::string> const& known) const
{
    std::string const name = node_.IsScalar() ? shortened(node_.Scalar()) : path_;
    return error(fmt::format("'{}' is no {}", name, what), "there is none of that name", suggest(name, known));
}

bool Yaml::has(std::string const& key) const
{
    return node_.IsMap() && node_[key].IsDefined() && !node_[key].IsNull();
}

Yaml Yaml::at(std::string const& key) const
{
    return {has(key) ? node_[key] : YAML::Node(), file_, path_ == "file" ? key : path_ + "." + key};
}

Yaml Yaml::needed(std::string const& key, std::string const& example) const
{
    if (!node_.IsMap())
        throw error(path_ + " is not a map", "keys and values are needed here", "write key: value lines");
    if (!has(key))
        throw error(fmt::format("{} has no '{}'", path_, key), "it has no usual value",
                    fmt::format("write {}: {}", key, example));
    return at(key);
}

std::vector<std::pair<Yaml, Yaml>> Yaml::entries(std::vector<InputError>& mistakes) const
{
    if (!node_.IsMap())
        throw error(path_ + " is not a map", "keys and values are needed here", "write key: value lines");
    std::set<std::string> seen;
    std::vector<std::pair<Yaml, Yaml>> out;
    for (auto const& entry : node_) {
        Yaml const key(entry.first, file_, path_);
        if (!entry.first.IsScalar()) {
            mistakes.push_back(key.error("a key is not text", "it is a list or a map", "name it"));
            continue;
        }
        std::string const name = entry.first.Scalar();
        if (!seen.insert(name).second)
            mistakes.push_back(key.error(fmt::format("key '{}' twice in {}", shortened(name), path_),
                                         "only one of them can count", "remove one"));
        else if (entry.second.IsNull())
            mistakes.push_back(key.error(fmt::format("key '{}' in {} has no value", shortened(name), path_),
                                         "it would be ignored", "give it one or remove it"));
        else
            out.emplace_back(key,
                             Yaml(entry.second, file_, path_ == "file" ? name : path_ + "." + shortened(name)));
    }
    return out;
}

std::vector<std::pair<Yaml, Yaml>> Yaml::entries() const
{
    std::vector<InputError> mistakes;
    auto out = entries(mistakes);
    if (!mistakes.empty()) throw mistakes.front();
    return out;
}

std::vector<std::string> Yaml::keys() const
{
    std::vector<std::string> out;
    for (auto const& [key, unused] : entries()) out.push_back(key.node_.Scalar());
    return out;
}

void Yaml::find_other_keys(std::vector<std::string> known, std::vector<InputError>& mistakes) const
{
    std::ranges::sort(known);
    for (auto const& [key, unused] : entries(mistakes)) {
        std::string const name = key.node_.Scalar();
        if (!std::ranges::binary_search(known, name))
            mistakes.push_back(key.error(fmt::format("unknown key '{}' in {}", shortened(name), path_),
                                         "it would be ignored", suggest(shortened(name), known)));
    }
}

void Yaml::check_keys(std::vector<std::string> known) const
{
    std::vector<InputError> mistakes;
    find_other_keys(std::move(known), mistakes);
    if (!mistakes.empty()) throw mistakes.front();
}

std::vector<Yaml> Yaml::items(std::size_t fewest, std::size_t most) const
{
    if (!node_.IsSequence())
        throw error(path_ + " is not a list", "a list is needed here",
                    "write [a, b] or lines that start with '- '");
    if (node_.size() < fewest || node_.size() > most)
        throw error(fmt::format("{} has {} entries", path_, node_.size()),
                    fewest == most ? fmt::format("{} are needed", fewest)
                                   : fmt::format("{} to {} are possible", fewest, most),
                    "write as many");
    std::vector<Yaml> out;
    for (auto const& item : node_) out.push_back({item, file_, fmt::format("{}[{}]", path_, out.size())});
    return out;
}

std::vector<Yaml> Yaml::one_or_more() const { return is_list() ? items() : std::vector<Yaml>{*this}; }

double Yaml::number(double low, double high) const
{
    if (node_.IsScalar()) {
        std::string s = node_.Scalar();
        if (s.ends_with('.')) s += '0'; // OpenCV writes 1. for 1
        if (auto const v = parse_finite(std::string_view(s).substr(s.starts_with('+') ? 1 : 0))) {
            if (*v >= low && *v <= high) return *v;
            throw error(fmt::format("{} is {}", path_, shortened(s)),
                        fmt::format("it must lie between {:g} and {:g}", low, high), "change it");
        }
    }
    throw error(path_ + " is not a number", "a finite number is needed here", "write 1 or 0.5");
}

std::int64_t Yaml::integer(std::int64_t low, std::int64_t high) const
{
    double const v = number(double(low), double(high));
    if (v != std::floor(v)) throw error(path_ + " is not whole", "a whole number is needed here", "round it");
    return std::int64_t(v);
}

std::uint64_t Yaml::seed() const
{
    if (auto const v = parse_number<std::uint64_t>(text())) return *v;
    throw error(path_ + " is no seed", "it is a whole number from 0 to 2^64 - 1", "write 20261");
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
    bool const is_name = !s.empty() && s.size() <= 64 && std::ranges::all_of(s, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '.' || c == '+' || c == '-';
    });
    if (!is_name)
        throw error(fmt::format("'{}' is no name", shortened(s)),
                    "names stand in tables: 1 to 64 letters, digits and _ . + -", "choose another");
    return s;
}

int Yaml::one_of(std::vector<std::string> const& words, std::string const& what) const
{
    auto const found = std::ranges::find(words, text());
    if (found == words.end()) throw unknown(what, words);
    return int(found - words.begin());
}

std::vector<double> Yaml::numbers(std::size_t count, double low, double high) const
{
    std::vector<double> out;
    for (Yaml const& item : items(count, count)) out.push_back(item.number(low, high));
    return out;
}

dvec3 Yaml::vector(double low, double high) const
{
    if (!node_.IsSequence() || node_.size() != 3)
        throw error(path_ + " is not three numbers", "a list of three is needed here", "write [0, 1, 0]");
    std::vector<double> const v = numbers(3, low, high);
    return {v[0], v[1], v[2]};
}

dvec3 Yaml::vector_or_number(double low, double high) const
{
    return node_.IsSequence() ? vector(low, high) : dvec3{number(low, high)};
}

} // namespace gi
