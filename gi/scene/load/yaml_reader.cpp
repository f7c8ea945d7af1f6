#include "gi/scene/load/yaml_reader.h"

#include "gi/core/edit_distance.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gi {
namespace {

constexpr std::size_t kLongestYaml = std::size_t(1) << 20; ///< the parser takes up to 300 times as much memory
constexpr int kDeepestYaml = 100;

/// The parser calls itself for every level and every alias; this is counted before it starts.
void check_shape(std::string const& text, std::string const& file)
{
    auto const refuse = [&](std::string const& why) {
        return InputError({file, 1, 1}, "this YAML is not read", why, "such files are small and flat");
    };
    if (text.size() > kLongestYaml) throw refuse("it is larger than 1 MiB");
    int flow = 0, line_depth = 0;
    std::size_t aliases = 0;
    bool at_start = true;
    std::vector<int> indents;
    int indent = 0;
    for (char const c : text) {
        if (c == '\n') {
            at_start = true;
            indent = 0;
            line_depth = 0;
            continue;
        }
        if (c == '[' || c == '{') ++flow;
        if ((c == ']' || c == '}') && flow > 0) --flow;
        if (at_start && (c == ' ' || c == '\t')) ++indent;
        if (c == '-' || c == '?' || c == ':') ++line_depth;
        if (at_start && c != ' ' && c != '\t') {
            at_start = false;
            while (!indents.empty() && indents.back() >= indent) indents.pop_back();
            indents.push_back(indent);
        }
        if (c == '*') ++aliases;
        if (flow > kDeepestYaml || line_depth > 50 * kDeepestYaml || int(indents.size()) > kDeepestYaml)
            throw refuse(fmt::format("it nests deeper than {} levels", kDeepestYaml));
        if (aliases > 1000) throw refuse("it has more than 1000 '*'");
    }
}

} // namespace

YamlReader YamlReader::parse(std::string const& text, std::string const& file, std::string const& root)
{
    check_shape(text, file);
    try {
        return {YAML::Load(text), file, root};
    } catch (YAML::Exception const& e) {
        throw InputError({file, e.mark.line + 1, e.mark.column + 1}, "this is not YAML", e.msg,
                         "check the indentation and the quotes");
    }
}

InputError YamlReader::error(std::string const& problem, std::string const& why,
                             std::string const& suggestion) const
{
    YAML::Mark const mark = node_.Mark();
    return {{file_, mark.line + 1, mark.column + 1}, problem, why, suggestion};
}

void YamlReader::only_keys(std::set<std::string> const& known) const
{
    if (!node_.IsMap())
        throw error(path_ + " is not a map", "keys and values are needed here", "write key: value lines");
    std::set<std::string> seen;
    for (auto const& entry : node_) {
        YamlReader const key(entry.first, file_, path_);
        if (!entry.first.IsScalar()) throw key.error("a key is not text", "it is a list or a map", "name it");
        std::string const name = entry.first.Scalar();
        if (!known.contains(name)) {
            auto const nearest = std::min_element(known.begin(), known.end(), [&](auto const& a, auto const& b) {
                return edit_distance(a, name.substr(0, 64)) < edit_distance(b, name.substr(0, 64));
            });
            bool const is_near =
                nearest != known.end() && edit_distance(*nearest, name.substr(0, 64)) <=
                                              std::max(1, int(name.size()) / 2); // as of study scripts
            throw key.error(fmt::format("unknown key '{}' in {}", name.substr(0, 64), path_),
                            "it would be ignored",
                            is_near         ? "did you mean '" + *nearest + "'?"
                            : known.empty() ? "remove it"
                                            : fmt::format("there are: {}", fmt::join(known, ", ")));
        }
        if (!seen.insert(name).second)
            throw key.error("key '" + name + "' twice in " + path_, "only one of them can count", "remove one");
    }
}

std::vector<std::string> YamlReader::keys() const
{
    if (!node_.IsMap())
        throw error(path_ + " is not a map", "keys and values are needed here", "write key: value lines");
    std::vector<std::string> out;
    for (auto const& entry : node_)
        if (entry.first.IsScalar()) out.push_back(entry.first.Scalar());
    return out;
}

std::vector<YamlReader> YamlReader::items() const
{
    if (!node_.IsSequence())
        throw error(path_ + " is not a list", "a list is needed here", "start each item with '- '");
    std::vector<YamlReader> out;
    for (std::size_t i = 0; i < node_.size(); ++i)
        out.push_back({node_[i], file_, fmt::format("{}[{}]", path_, i)});
    return out;
}

double YamlReader::number(double low, double high) const
{
    double v = 0;
    if (node_.IsScalar()) {
        std::string const& s = node_.Scalar();
        char const* const begin = s.data() + (s.starts_with('+') ? 1 : 0);
        auto const [end, failure] = std::from_chars(begin, s.data() + s.size(), v);
        if (failure == std::errc{} && end == s.data() + s.size() && !s.empty()) {
            if (v >= low && v <= high) return v;
            throw error(fmt::format("{} is {}", path_, s),
                        fmt::format("it must lie between {:g} and {:g}", low, high), "change it");
        }
    }
    throw error(path_ + " is not a number", "a number is needed here", "write 1 or 0.5");
}

std::int64_t YamlReader::integer(std::int64_t low, std::int64_t high) const
{
    double const v = number(double(low), double(high));
    if (v != std::floor(v)) throw error(path_ + " is not whole", "a whole number is needed here", "round it");
    return std::int64_t(v);
}

bool YamlReader::boolean() const
{
    if (node_.IsScalar() && (node_.Scalar() == "true" || node_.Scalar() == "false"))
        return node_.Scalar() == "true";
    throw error(path_ + " is neither true nor false", "one of them is needed here", "write true or false");
}

std::string YamlReader::text() const
{
    if (!node_.IsScalar()) throw error(path_ + " is not text", "a name is needed here", "write one word");
    return node_.Scalar();
}

dvec3 YamlReader::vector(double low, double high) const
{
    if (!node_.IsSequence() || node_.size() != 3)
        throw error(path_ + " is not three numbers", "a list of three is needed here", "write [0, 1, 0]");
    dvec3 v;
    for (int i = 0; i < 3; ++i)
        v[i] = YamlReader(node_[std::size_t(i)], file_, fmt::format("{}[{}]", path_, i)).number(low, high);
    return v;
}

dvec3 YamlReader::vector_or_number(double low, double high) const
{
    return node_.IsSequence() ? vector(low, high) : dvec3{number(low, high)};
}

} // namespace gi
