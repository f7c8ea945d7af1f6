#include "ar/camera/yaml.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <set>
#include <unistd.h>

namespace ar {
namespace {

constexpr std::size_t kLongest = std::size_t(1) << 20; ///< the parser takes up to 300 times as much memory
constexpr int kDeepest = 60;

/// The parser calls itself for every level and every alias; this is counted before it starts.
void check_shape(std::string const& text, std::string const& file)
{
    int flow = 0, marks = 0, indent = 0, aliases = 0;
    bool at_start = true;
    std::vector<int> indents;
    std::string why = text.size() > kLongest ? "it is larger than 1 MiB" : "";
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
        if (flow > kDeepest || marks > 50 * kDeepest || int(indents.size()) > kDeepest)
            why = fmt::format("it nests deeper than {} levels", kDeepest);
        if (aliases > 1000) why = "it has more than 1000 '*'";
    }
    if (!why.empty())
        throw InputError({file, 1, 1}, "this YAML is not read", why, "such files are small and flat");
}

std::string shortened(std::string const& s) { return s.substr(0, 64); }

} // namespace

Yaml Yaml::parse(std::string const& text, std::string const& file)
{
    check_shape(text, file);
    try {
        std::string readable = text;
        if (readable.starts_with("%YAML:1.0")) readable[5] = ' '; // FileStorage's spelling
        return {YAML::Load(readable), file, "file"};
    } catch (YAML::Exception const& e) {
        throw InputError({file, e.mark.line + 1, e.mark.column + 1}, "this is not YAML", e.msg,
                         "check the indentation and the quotes");
    }
}

Place Yaml::place() const
{
    YAML::Mark const mark = node_.Mark();
    return {file_, mark.line + 1, mark.column + 1};
}

InputError Yaml::error(std::string const& problem, std::string const& why, std::string const& suggestion) const
{
    return {place(), problem, why, suggestion};
}

bool Yaml::has(std::string const& key) const { return node_.IsMap() && node_[key].IsDefined(); }

Yaml Yaml::at(std::string const& key, std::string const& example) const
{
    if (!node_.IsMap())
        throw error(path_ + " is not a map", "keys and values are needed here", "write key: value");
    if (!has(key))
        throw error(fmt::format("{} has no '{}'", path_, key), "it has no usual value",
                    fmt::format("write {}: {}", key, example));
    return {node_[key], file_, path_ == "file" ? key : path_ + "." + key};
}

std::vector<std::string> Yaml::keys() const
{
    if (!node_.IsMap())
        throw error(path_ + " is not a map", "keys and values are needed here", "write key: value");
    std::set<std::string> seen;
    std::vector<std::string> all;
    for (auto const& entry : node_) {
        Yaml const key(entry.first, file_, path_);
        if (!entry.first.IsScalar()) throw key.error("a key is not text", "it is a list or a map", "name it");
        std::string const name = entry.first.Scalar();
        if (!seen.insert(name).second)
            throw key.error(fmt::format("key '{}' twice in {}", shortened(name), path_),
                            "only one of them can count", "remove one");
        if (entry.second.IsNull())
            throw key.error(fmt::format("key '{}' in {} has no value", shortened(name), path_),
                            "it would be ignored", "give it one or remove it");
        all.push_back(name);
    }
    return all;
}

void Yaml::only_keys(std::vector<std::string> const& known) const
{
    for (std::string const& name : keys()) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        Place at = place();
        for (auto const& entry : node_)
            if (entry.first.Scalar() == name) at = Yaml(entry.first, file_, path_).place();
        throw InputError(at, fmt::format("unknown key '{}' in {}", shortened(name), path_), "it would be ignored",
                         fmt::format("there are: {}", fmt::join(known, ", ")));
    }
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

double Yaml::number(double low, double high) const
{
    double v = 0;
    if (node_.IsScalar()) {
        std::string s = node_.Scalar();
        if (s.ends_with('.')) s += '0'; // FileStorage writes 1. for 1
        char const* const begin = s.data() + (s.starts_with('+') ? 1 : 0);
        char const* const all = s.data() + s.size();
        auto const [end, failure] = std::from_chars(begin, all, v);
        if (failure == std::errc{} && end == all && begin != end && std::isfinite(v)) {
            if (v >= low && v <= high) return v;
            throw error(fmt::format("{} is {}", path_, shortened(s)),
                        fmt::format("it must lie between {:g} and {:g}", low, high), "change it");
        }
    }
    throw error(path_ + " is not a finite number", "a number is needed here", "write 1 or 0.5");
}

int Yaml::integer(int low, int high) const
{
    double const v = number(low, high);
    if (v != std::floor(v)) throw error(path_ + " is not whole", "a whole number is needed here", "round it");
    return int(v);
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

std::vector<double> Yaml::numbers(std::size_t count, double low, double high) const
{
    std::vector<double> out;
    for (Yaml const& item : items(count, count)) out.push_back(item.number(low, high));
    return out;
}

std::string read_text(std::filesystem::path const& file, std::size_t most_bytes)
{
    auto const fail = [&](std::string const& why) {
        throw InputError("'" + file.string() + "' cannot be read", why, "check the path");
    };
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) fail("it is a folder");
    std::ifstream in(file, std::ios::binary);
    if (!in) fail(std::strerror(errno));
    std::string text(most_bytes + 1, '\0');
    in.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(in.gcount()));
    if (in.bad()) fail("reading failed");
    if (text.size() > most_bytes) fail(fmt::format("it is larger than {} bytes", most_bytes));
    return text;
}

void write_text(std::filesystem::path const& file, std::string const& text)
{
    std::string const temporary = fmt::format("{}.tmp-{}", file.string(), getpid());
    int const fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    int failure = fd < 0 ? errno : 0;
    for (std::size_t at = 0; failure == 0 && at < text.size();) {
        ssize_t const n = ::write(fd, text.data() + at, text.size() - at);
        if (n > 0) at += std::size_t(n);
        if (n == 0) failure = ENOSPC;
        if (n < 0 && errno != EINTR) failure = errno;
    }
    if (fd >= 0) {
        if (failure == 0 && ::fsync(fd) != 0) failure = errno;
        ::close(fd);
    }
    if (failure == 0 && std::rename(temporary.c_str(), file.c_str()) != 0) failure = errno;
    if (failure == 0) return;
    if (fd >= 0) ::unlink(temporary.c_str());
    throw InputError("'" + file.string() + "' cannot be written", std::strerror(failure), "choose another folder");
}

} // namespace ar
