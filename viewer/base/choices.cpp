#include "viewer/base/choices.h"

#include "gi/core/text.h"

#include <CLI/CLI.hpp>
#include <map>

namespace viewer {
namespace {

std::map<CLI::Option const*, std::vector<std::string>>& offered()
{
    static std::map<CLI::Option const*, std::vector<std::string>> all;
    return all;
}

} // namespace

CLI::Option* offer(CLI::Option* option, std::vector<std::string> values)
{
    offered()[option] = std::move(values);
    return option;
}

std::vector<std::string> choices_of(CLI::Option const& option)
{
    if (auto const found = offered().find(&option); found != offered().end()) return found->second;
    std::string const type = option.get_type_name(); // "TEXT:{srgb,filmic}"
    auto const open = type.find('{'), close = type.rfind('}');
    if (open == type.npos || close == type.npos) return {};
    auto const parts = gi::split_at_commas(std::string_view(type).substr(open + 1, close - open - 1));
    return {parts.begin(), parts.end()};
}

} // namespace viewer
