#pragma once
// Everything that is wrong with a YAML file. Parsing continues after a mistake, so that all are reported at once.

#include "gi/core/yaml.h"

#include <string>
#include <string_view>
#include <vector>

namespace gi {

class Mistakes {
public:
    void add(InputError const& e) { all_.push_back(e); }
    /// Calls read(); what it throws is added. Returns whether it threw nothing.
    template <class Read>
    bool attempt(Read const& read)
    {
        try {
            read();
            return true;
        } catch (InputError const& e) {
            add(e);
            return false;
        }
    }
    /// Reads a key's value if it is there, with read(value).
    template <class Read>
    bool take(Yaml const& map, char const* key, Read const& read)
    {
        return !map.has(key) || attempt([&] { read(map.at(key)); });
    }
    /// As take(), and the key must be there. @param example  a value to write
    template <class Read>
    bool need(Yaml const& map, char const* key, char const* example, Read const& read)
    {
        if (map.is_map() && !map.has(key) && suggests_key(map, key)) return false; // reported as a misspelling
        return attempt([&] { read(map.needed(key, example)); });
    }
    /// Entries of a map; those that are wrong are added and left out.
    std::vector<std::pair<Yaml, Yaml>> entries(Yaml const& map)
    {
        std::vector<std::pair<Yaml, Yaml>> out;
        attempt([&] { out = map.entries(all_); });
        return out;
    }
    /// Adds the keys of a map that are not among the known ones.
    void check_keys(Yaml const& map, std::vector<std::string> const& known)
    {
        attempt([&] { map.find_other_keys(known, all_); });
    }

    bool empty() const { return all_.empty(); }
    std::size_t count() const { return all_.size(); }
    /// True if one of the mistakes suggests this word: the file means it, but writes another.
    bool suggests(std::string_view word) const;
    /// In the order of the file, each once.
    std::vector<InputError> in_order() const;

private:
    bool suggests_key(Yaml const& map, char const* key) const;

    std::vector<InputError> all_;
};

} // namespace gi
