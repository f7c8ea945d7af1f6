#include "study/script/written_settings.h"

#include "gi/core/yaml.h"

#include <algorithm>

namespace study {
namespace {

class Collector {
public:
    explicit Collector(Script const& s) : s_(s) {}

    void collect(gi::Yaml const& y)
    {
        if (y.has("defaults")) add_camera_and_settings(y.at("defaults"));
        for (auto const& [key, value] : entries(y, "factors")) add_factor(key, value);
        for (auto const& [key, value] : entries(y, "blocks")) {
            add_camera_and_settings(value);
            if (value.has("compare")) add_compare(key.text(), value.at("compare"));
        }
    }

    std::vector<WrittenSetting> found;

private:
    using Entries = std::vector<std::pair<gi::Yaml, gi::Yaml>>;

    static Entries entries(gi::Yaml const& y)
    {
        std::vector<gi::InputError> told; // by read_script
        return y.is_map() ? y.entries(told) : Entries{};
    }
    static Entries entries(gi::Yaml const& y, char const* key)
    {
        return y.has(key) ? entries(y.at(key)) : Entries{};
    }

    void add(gi::Yaml const& key, std::string const& name, gi::Yaml const& value)
    {
        if (value.is_text()) found.push_back({name, value.text(), key.place(), value.place(), "", {}, {}});
    }
    void add_patch(gi::Yaml const& map)
    {
        for (auto const& [key, value] : entries(map)) add(key, key.text(), value);
    }
    void add_camera_and_settings(gi::Yaml const& y)
    {
        if (y.has("camera")) add(y.at("camera"), "camera", y.at("camera"));
        if (y.has("settings")) add_patch(y.at("settings"));
    }
    void add_factor(gi::Yaml const& key, gi::Yaml const& value)
    {
        if (value.is_list())
            for (gi::Yaml const& level : value.items()) add(key, key.text(), level);
        for (auto const& [level, patch] : entries(value)) add_patch(patch);
    }
    void add_compare(std::string const& name, gi::Yaml const& compare)
    {
        if (compare.has("with")) add_patch(compare.at("with"));
        auto const block =
            std::find_if(s_.blocks.begin(), s_.blocks.end(), [&](Block const& b) { return b.name == name; });
        if (!compare.has("vary") || !compare.at("vary").is_text() || block == s_.blocks.end()) return;
        gi::Yaml const vary = compare.at("vary");
        found.push_back({vary.text(), "", vary.place(), vary.place(), name, {}, {}});
        if (!block->compare || block->is_broken) return;
        found.back().varied = presented_ends(*block);
        for (Procedure const& p : block->procedures) {
            auto const& listed = p.method == Method::questplus ? p.stimuli : p.levels;
            found.back().levels.insert(found.back().levels.end(), listed.begin(), listed.end());
        }
        std::ranges::sort(found.back().levels);
        for (auto const& [key, value] : entries(compare, "also"))
            for (FurtherSetting const& f : block->compare->also)
                if (f.setting == key.text())
                    found.push_back({f.setting, "", key.place(), key.place(), name, std::pair{f.low, f.high}, {}});
    }

    Script const& s_;
};

} // namespace

std::pair<double, double> presented_ends(Block const& b)
{
    std::vector<double> levels;
    Compare const& c = *b.compare;
    for (Procedure const& p : b.procedures) {
        if (p.method == Method::constant) levels.insert(levels.end(), p.levels.begin(), p.levels.end());
        if (p.method == Method::questplus) levels.insert(levels.end(), p.stimuli.begin(), p.stimuli.end());
        if (p.method == Method::staircase || p.method == Method::adjustment)
            levels.insert(levels.end(), {c.low, c.high});
    }
    if (b.practice.trials > 0) levels.push_back(b.practice.level.value_or(c.harder_up ? c.low : c.high));
    if (b.catches.every > 0 && b.catches.kind == CatchLevel::number) levels.push_back(b.catches.level);
    if (levels.empty()) return {c.low, c.high};
    auto const [low, high] = std::minmax_element(levels.begin(), levels.end());
    return {*low, *high};
}

std::vector<WrittenSetting> written_settings(Script const& script, std::string const& text)
{
    Collector collector(script);
    collector.collect(gi::Yaml::parse(text, script.file, "script"));
    return std::move(collector.found);
}

} // namespace study
