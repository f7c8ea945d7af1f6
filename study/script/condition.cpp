#include "study/script/condition.h"

#include <fmt/format.h>

namespace study {

double easiest(Compare const& compare) { return compare.harder_up ? compare.low : compare.high; }

std::vector<int> crossed_levels(Script const& script, Block const& block, int factor)
{
    if (!block.only[std::size_t(factor)].empty()) return block.only[std::size_t(factor)];
    std::vector<int> all;
    for (std::size_t i = 0; i < script.factors[std::size_t(factor)].levels.size(); ++i) all.push_back(int(i));
    return all;
}

std::string plain_key(std::string const& key) { return key.starts_with("gi.") ? key.substr(3) : key; }

void set_setting(Patch& patch, std::string const& key, std::string const& value)
{
    for (auto& [name, old] : patch)
        if (name == key) {
            old = value;
            return;
        }
    patch.emplace_back(key, value);
}

Patch settings_of(Script const& script, Block const& block, Stimulus const& stimulus)
{
    Patch patch = block.settings; // includes those of defaults
    for (std::size_t f = 0; f < script.factors.size(); ++f)
        for (auto const& [key, value] : script.factors[f].levels[std::size_t(stimulus.levels[f])].settings)
            set_setting(patch, key, value);
    if (!block.compare) return patch;
    auto const& also = block.compare->also;
    for (std::size_t i = 0; i < also.size(); ++i)
        set_setting(patch, also[i].setting, level_text(stimulus.also.empty() ? also[i].usual : stimulus.also[i]));
    if (!stimulus.is_varied) return patch;
    for (auto const& [key, value] : block.compare->with) set_setting(patch, key, value);
    if (stimulus.level && !block.compare->vary.empty())
        set_setting(patch, block.compare->vary, level_text(*stimulus.level));
    return patch;
}

std::string level_text(double level) { return fmt::format("{:.9g}", level); }

} // namespace study
