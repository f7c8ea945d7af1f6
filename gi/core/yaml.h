#pragma once
// YAML with places: every value knows its line and column; unknown keys, duplicate keys and keys without a value
// are errors. All errors are InputErrors with the place in the file.

#include "gi/core/error.h"
#include "gi/core/math.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace gi {

class Yaml {
public:
    /// Parses the whole text; OpenCV's "%YAML:1.0" is accepted too.
    /// @param file  for messages
    /// @param root  the name of the whole in messages; "file" is left out of the names of its values
    /// @throws InputError not YAML, not UTF-8, control characters, several documents, larger than 1 MiB, too
    /// deeply nested, or too many aliases
    static Yaml parse(std::string const& text, std::string const& file, std::string const& root = "file");

    TextLocation place() const;
    /// The name of this value in messages: "scene.camera.fov".
    std::string const& path() const { return path_; }
    InputError error(std::string const& problem, std::string const& why, std::string const& suggestion) const;
    /// "'x' is no `what`", with the nearest known word.
    InputError unknown(std::string const& what, std::vector<std::string> const& known) const;

    bool is_map() const { return node_.IsMap(); }
    bool is_list() const { return node_.IsSequence(); }
    bool is_text() const { return node_.IsScalar(); }
    /// True if the text stands in quotes; place() is that of the quote then.
    bool is_quoted() const { return node_.IsScalar() && node_.Tag() == "!"; }
    /// True if this is a map in which the key has a value.
    bool has(std::string const& key) const;
    /// The value of a key; where it is missing, all reading functions throw.
    Yaml at(std::string const& key) const;
    /// As at(). @throws InputError the key is missing; `example` is a value to write
    Yaml needed(std::string const& key, std::string const& example) const;
    /// Keys (as values with their places) and their values, in the order of the file. @throws InputError this is
    /// no map, or a key is no text, is there twice or has no value
    std::vector<std::pair<Yaml, Yaml>> entries() const;
    /// As entries(), but what is wrong with an entry is added to `mistakes`, and the entry left out.
    /// @throws InputError this is no map
    std::vector<std::pair<Yaml, Yaml>> entries(std::vector<InputError>& mistakes) const;
    std::vector<std::string> keys() const;
    /// @throws InputError as entries(), or there is another key than these
    template <class Words>
    void only_keys(Words const& known) const
    {
        check_keys({known.begin(), known.end()});
    }
    void only_keys(std::initializer_list<char const*> known) const { check_keys({known.begin(), known.end()}); }
    /// As only_keys(), but adds everything that is wrong to `mistakes`. @throws InputError this is no map
    void find_other_keys(std::vector<std::string> known, std::vector<InputError>& mistakes) const;
    /// @throws InputError this is no list of `fewest` to `most` items
    std::vector<Yaml> items(std::size_t fewest = 0, std::size_t most = SIZE_MAX) const;
    /// The items of a list, or this value alone.
    std::vector<Yaml> one_or_more() const;

    /// A finite number in [low, high].
    double number(double low, double high) const;
    std::int64_t integer(std::int64_t low, std::int64_t high) const;
    /// 0 to 2^64 - 1
    std::uint64_t seed() const;
    bool boolean() const;
    std::string text() const;
    /// Text that can be a name in tables and files: letters, digits and _ . + -, at most 64.
    std::string name() const;
    /// The index of the text in `words`; `what` names them in the message.
    int one_of(std::vector<std::string> const& words, std::string const& what) const;
    /// A list of exactly `count` numbers.
    std::vector<double> numbers(std::size_t count, double low, double high) const;
    dvec3 vector(double low = -1e18, double high = 1e18) const;
    /// A number stands for three equal ones.
    dvec3 vector_or_number(double low, double high) const;

private:
    Yaml(YAML::Node node, std::string file, std::string path)
        : node_(std::move(node)), file_(std::move(file)), path_(std::move(path))
    {
    }
    void check_keys(std::vector<std::string> known) const;

    YAML::Node node_;
    std::string file_, path_;
};

} // namespace gi
