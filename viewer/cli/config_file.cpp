#include "viewer/cli/config_file.h"

#include "gi/core/file.h"
#include "gi/core/yaml.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/command_tree.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>

namespace viewer {
namespace {

struct Called {
    CLI::App const* command;
    std::string name; ///< "study run"
    std::ptrdiff_t words = 0;
};

Called called(CLI::App const& app, std::vector<std::string> const& words)
{
    Called c{&app, "", 0};
    for (std::string const& word : words) {
        CLI::App const* const next = find_subcommand(*c.command, word);
        if (next == nullptr) break;
        c = {next, c.name + (c.name.empty() ? "" : " ") + word, c.words + 1};
    }
    return c;
}

/// True if a section's first words are a command of the table, with which its program is left to judge the rest.
bool is_command(std::string const& section)
{
    for (CommandRow const& c : commands())
        if (section == c.name || section.starts_with(std::string(c.name) + " ")) return true;
    return false;
}

void add_option(gi::Yaml const& value, CLI::Option const& option, std::vector<std::string>& out)
{
    if (option.get_items_expected_max() == 0) { // a flag
        if (value.boolean()) out.push_back(longest_name(option));
        return;
    }
    for (gi::Yaml const& v : value.one_or_more()) out.push_back(longest_name(option) + "=" + v.text());
}

} // namespace

std::string config_file()
{
    auto const variable = [](char const* name) {
        char const* const value = std::getenv(name);
        return std::string(value == nullptr ? "" : value);
    };
    std::error_code none;
    if (std::string const named = variable("LIGHTWELL_CONFIG"); !named.empty()) {
        if (named == "none") return {};
        if (!std::filesystem::exists(named, none))
            throw gi::InputError("LIGHTWELL_CONFIG=" + named, "there is no such file", "name a file, or none");
        return named;
    }
    std::string folder = variable("XDG_CONFIG_HOME");
    if (folder.empty() && !variable("HOME").empty()) folder = variable("HOME") + "/.config";
    std::string const file = folder + "/lightwell/config.yaml";
    return !folder.empty() && std::filesystem::is_regular_file(file, none) ? file : std::string();
}

std::vector<std::string> add_configured_options(CLI::App const& app, std::string const& file,
                                                std::vector<std::string>& words)
{
    Called const now = called(app, words);
    std::vector<std::string> added;
    if (now.words == 0) return added;
    gi::Yaml const config = gi::Yaml::parse(gi::read_text(file, 1 << 20), file, "configuration");
    for (auto const& [section, options] : config.entries()) {
        std::string const name = section.text();
        if (!is_command(name)) {
            std::vector<std::string> known;
            for (CommandRow const& c : commands()) known.emplace_back(c.name);
            throw section.unknown("command", known);
        }
        if (name != now.name) continue;
        for (auto const& [key, value] : options.entries()) {
            CLI::Option const* const option = find_option(*now.command, "--" + key.text());
            if (option == nullptr) {
                std::vector<std::string> known;
                for (std::string const& n : option_names(*now.command)) known.push_back(n.substr(2));
                throw key.unknown("option of " + name, known);
            }
            bool const is_given = std::any_of(words.begin() + now.words, words.end(), [&](std::string const& w) {
                return w.starts_with('-') && option->check_name(w.substr(0, w.find('=')));
            });
            if (!is_given) add_option(value, *option, added);
        }
    }
    words.insert(words.begin() + now.words, added.begin(), added.end());
    return added;
}

} // namespace viewer
