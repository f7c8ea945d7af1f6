#pragma once
// YAML with places: every value knows its line and column; keys that nobody asked for, and keys without a value,
// are errors.

#include "study/script/script_error.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace study {

class Yaml {
public:
    Yaml(YAML::Node node, std::string const& file, std::string path)
        : node_(std::move(node)), file_(file), path_(std::move(path))
    {
    }
    /// The whole text. Throws ScriptError where it is not YAML, is several documents, or nests or expands without
    /// bounds.
    /// @param file as named in messages; must live as long as this and all that comes of it
    /// @param what the whole is called in messages
    static Yaml parse(std::string const& text, std::string const& file, std::string const& what = "script");

    Place place() const;
    std::string const& path() const { return path_; }
    ScriptError error(std::string const& problem, std::string const& why, std::string const& suggestion) const;
    /// "'x' is no `what`", with the nearest of what there is.
    ScriptError unknown(std::string const& what, std::vector<std::string> const& known) const;

    bool is_map() const { return node_.IsMap(); }
    bool is_list() const { return node_.IsSequence(); }
    bool is_text() const { return node_.IsScalar(); }
    bool has(std::string const& key) const;
    Yaml at(std::string const& key) const;
    /// As at(), where it has to be. @param example of what to write
    Yaml needed(std::string const& key, std::string const& example) const;
    /// Throws unless this is a map with no other keys than these, each once and with a value.
    void only_keys(std::set<std::string> const& known) const;
    /// Keys (as values with their places) and what belongs to them, as written. Throws unless this is a map with
    /// each key once.
    std::vector<std::pair<Yaml, Yaml>> entries() const;
    std::vector<Yaml> items() const;
    /// A list, or one thing as a list of one.
    std::vector<Yaml> one_or_more() const;

    double number(double low, double high) const;
    int integer(int low, int high) const;
    std::uint64_t seed() const;
    bool boolean() const;
    std::string text() const;
    /// Text that can be a name in tables and files: letters, digits and _ . + -, at most 64.
    std::string name() const;
    /// The index of the text in `words`; `what` names them in the message.
    int one_of(std::vector<std::string> const& words, std::string const& what) const;

private:
    YAML::Node node_;
    std::string const& file_;
    std::string path_;
};

} // namespace study
