#include "viewer/cli/command_tree.h"

#include <CLI/CLI.hpp>

namespace viewer {

std::vector<CLI::App const*> subcommands(CLI::App const& app)
{
    return app.get_subcommands([](CLI::App const*) { return true; });
}

CLI::App const* find_subcommand(CLI::App const& app, std::string const& name)
{
    for (CLI::App const* const s : subcommands(app))
        if (s->get_name() == name) return s;
    return nullptr;
}

CLI::Option const* find_option(CLI::App const& app, std::string const& word)
{
    std::string const name = word.substr(0, word.find('='));
    for (CLI::Option const* const o : app.get_options())
        if (!o->get_positional() && o->check_name(name)) return o;
    return nullptr;
}

std::string longest_name(CLI::Option const& option)
{
    auto const& names = option.get_lnames();
    return names.empty() ? "-" + option.get_snames().front() : "--" + names.front();
}

std::vector<std::string> option_names(CLI::App const& app)
{
    std::vector<std::string> names;
    for (CLI::Option const* const o : app.get_options())
        if (!o->get_positional() && !o->get_group().empty()) names.push_back(longest_name(*o));
    return names;
}

} // namespace viewer
