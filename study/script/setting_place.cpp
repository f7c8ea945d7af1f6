#include "study/script/setting_place.h"

#include "gi/core/yaml.h"

namespace study {
namespace {

bool is_set(Place p) { return p.line > 0; }

Place find(gi::Yaml const& at, std::string const& key, std::string const& value)
{
    Place found;
    if (at.is_list())
        for (gi::Yaml const& item : at.items())
            if (found = find(item, key, value); is_set(found)) return found;
    if (!at.is_map()) return found;
    for (auto const& [name, what] : at.entries()) {
        bool const is_varied = name.text() == "vary" && what.is_text() && what.text() == key;
        if (is_varied) return what.place();
        if (name.text() == key) {
            if (what.is_text() && what.text() == value) return what.place();
            if (what.is_list())
                for (gi::Yaml const& level : what.items())
                    if (level.is_text() && level.text() == value) return level.place();
        }
        if (found = find(what, key, value); is_set(found)) return found;
    }
    return found;
}

} // namespace

Place place_of_setting(std::string const& text, std::string const& key, std::string const& value)
{
    std::string const file;
    return find(gi::Yaml::parse(text, file, "script"), key, value);
}

} // namespace study
