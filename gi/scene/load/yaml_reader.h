#pragma once
// YAML with places: every value knows its line and column, every key that nobody asked for is an error.

#include "gi/core/error.h"
#include "gi/core/math.h"

#include <optional>
#include <set>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace gi {

class YamlReader {
public:
    YamlReader(YAML::Node node, std::string file, std::string path)
        : node_(std::move(node)), file_(std::move(file)), path_(std::move(path))
    {
    }
    /// The whole text, called `root` in messages. Throws InputError where it is not YAML, nests or expands without
    /// bounds.
    static YamlReader parse(std::string const& text, std::string const& file, std::string const& root = "scene");

    InputError error(std::string const& problem, std::string const& why, std::string const& suggestion) const;

    bool is_map() const { return node_.IsMap(); }
    bool is_list() const { return node_.IsSequence(); }
    bool is_text() const { return node_.IsScalar(); }
    /// Throws unless this is a map with no other keys than these, each once; names the nearest one.
    void only_keys(std::set<std::string> const& known) const;
    /// Of a map, in order; keys that are not text are left out. Throws unless this is a map.
    std::vector<std::string> keys() const;
    bool has(std::string const& key) const { return node_[key].IsDefined() && !node_[key].IsNull(); }
    YamlReader at(std::string const& key) const { return {node_[key], file_, path_ + "." + key}; }
    std::vector<YamlReader> items() const;

    double number(double low, double high) const;
    std::int64_t integer(std::int64_t low, std::int64_t high) const;
    bool boolean() const;
    std::string text() const;
    dvec3 vector(double low = -1e18, double high = 1e18) const;
    /// A number stands for three equal ones.
    dvec3 vector_or_number(double low, double high) const;

private:
    YAML::Node node_;
    std::string file_, path_;
};

} // namespace gi
