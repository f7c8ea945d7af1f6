#include "viewer/bench/sweep_methods.h"

#include "gi/core/error.h"
#include "gi/methods/slhb/settings.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {

void check_sweep_methods(CLI::App const& command, RenderOptions const& options,
                         std::vector<std::string> const& names)
{
    std::vector<NamedMethod> methods;
    bool shared = false; // some method uses --schedule
    for (std::string const& name : names) {
        std::size_t const colon = name.find(':');
        bool const own = colon != std::string::npos && !name.starts_with("vpl_");
        shared |= name == "slhb";
        methods.push_back({name.substr(0, colon),
                           gi::parse_schedule(own ? name.substr(colon + 1) : options.schedule),
                           own ? "--methods " + name : "--schedule " + options.schedule});
    }
    check_slhb(command, methods);
    check_virtual_lights(command, methods);
    if (!shared && command.get_option("--schedule")->count() > 0)
        throw gi::InputError(fmt::format("--schedule with --methods {}", fmt::join(names, ",")),
                             "it applies only to 'slhb' without a schedule of its own", "leave one of them out");
}

} // namespace viewer
