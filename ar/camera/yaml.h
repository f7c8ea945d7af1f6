#pragma once
// YAML with places: every value knows its line and column; keys that nobody asked for, keys twice and keys without
// a value are errors.

#include "ar/camera/error.h"

#include <filesystem>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace ar {

class Yaml {
public:
    /// The whole text; what FileStorage of OpenCV writes ("%YAML:1.0") is read too.
    /// @param file for messages. @throws InputError not YAML, larger than 1 MiB, nested too deep or with too many
    /// aliases
    static Yaml parse(std::string const& text, std::string const& file);

    Place place() const;
    /// How messages call it: "calibration.camera_matrix".
    std::string const& path() const { return path_; }
    InputError error(std::string const& problem, std::string const& why, std::string const& suggestion) const;

    bool is_map() const { return node_.IsMap(); }
    bool is_list() const { return node_.IsSequence(); }
    bool has(std::string const& key) const;
    /// @throws InputError it is not there; `example` of what to write
    Yaml at(std::string const& key, std::string const& example) const;
    /// @throws InputError unless this is a map with no other keys, each once and with a value
    void only_keys(std::vector<std::string> const& known) const;
    std::vector<std::string> keys() const;
    /// @throws InputError unless this is a list of at least and at most so many
    std::vector<Yaml> items(std::size_t fewest = 0, std::size_t most = 100000) const;

    /// A finite number. @throws InputError another thing, or outside
    double number(double low, double high) const;
    int integer(int low, int high) const;
    bool boolean() const;
    std::string text() const;
    /// A list of exactly so many numbers.
    std::vector<double> numbers(std::size_t count, double low, double high) const;

private:
    Yaml(YAML::Node node, std::string file, std::string path)
        : node_(std::move(node)), file_(std::move(file)), path_(std::move(path))
    {
    }
    YAML::Node node_;
    std::string file_, path_;
};

/// @throws InputError it cannot be read, or is larger than `most_bytes`
std::string read_text(std::filesystem::path const& file, std::size_t most_bytes = std::size_t(1) << 20);
/// Through a temporary file beside it that is renamed: the file is whole or as it was.
/// @throws InputError naming the file
void write_text(std::filesystem::path const& file, std::string const& text);

} // namespace ar
