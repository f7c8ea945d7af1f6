#pragma once
// Everything that is wrong with a script. Reading goes on after a mistake, so that all are told at once.

#include "gi/core/yaml.h"
#include "study/script/script_error.h"

#include <string>
#include <string_view>
#include <vector>

namespace study {

class Mistakes {
public:
    void add(gi::InputError const& e) { all_.push_back(e); }
    /// Calls read(); what it throws is added. Returns whether it threw nothing.
    template <class Read>
    bool attempt(Read const& read)
    {
        try {
            read();
            return true;
        } catch (gi::InputError const& e) {
            add(e);
            return false;
        }
    }
    /// As attempt(), for what others do without: it does not count as grave.
    template <class Read>
    bool attempt_aside(Read const& read)
    {
        bool const is_fine = attempt(read);
        aside_ += !is_fine;
        return is_fine;
    }
    /// Reads a key's value if it is there, with read(value).
    template <class Read>
    bool take(gi::Yaml const& map, char const* key, Read const& read)
    {
        return !map.has(key) || attempt([&] { read(map.at(key)); });
    }
    /// As take(), and the key must be there. @param example  a value to write
    template <class Read>
    bool need(gi::Yaml const& map, char const* key, char const* example, Read const& read)
    {
        if (map.is_map() && !map.has(key) && suggests_key(map, key)) return false; // told: it is written otherwise
        return attempt([&] { read(map.needed(key, example)); });
    }
    /// Entries of a map; those that are wrong are added and left out.
    std::vector<std::pair<gi::Yaml, gi::Yaml>> entries(gi::Yaml const& map)
    {
        std::vector<std::pair<gi::Yaml, gi::Yaml>> out;
        attempt([&] { out = map.entries(all_); });
        return out;
    }
    /// Keys that do not belong to this kind of mapping (study/script/keys.h).
    void check_keys(gi::Yaml const& map, char const* kind);

    bool empty() const { return all_.empty(); }
    std::size_t count() const { return all_.size(); }
    std::size_t grave() const { return all_.size() - aside_; }
    /// True if one of the mistakes suggests this word: the script means it, but writes another.
    bool suggests(std::string_view word) const;
    /// In the order of the script, each once.
    std::vector<ScriptError> in_order() const;

private:
    bool suggests_key(gi::Yaml const& map, char const* key) const;

    std::vector<gi::InputError> all_;
    std::size_t aside_ = 0;
};

} // namespace study
