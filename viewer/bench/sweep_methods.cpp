#include "viewer/bench/sweep_methods.h"

#include "gi/core/error.h"
#include "viewer/bench/sweep_plan.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {

void check_sweep_methods(CLI::App const& command, RenderOptions const& options,
                         std::vector<std::string> const& names)
{
    std::vector<gi::ChosenMethod> methods;
    for (std::string const& name : names) {
        SweepMethod const m = find_sweep_method(name);
        methods.push_back(chosen_method(options, std::string(m.method.name)));
        if (m.option == nullptr || m.option->name != "schedule") continue;
        methods.back().schedule = settings_of(m, options.settings).slhb.schedule;
        methods.back().as_given = "--methods " + name;
    }
    check_method_options(command, options.settings, methods);
    bool const shared = std::ranges::find(names, "slhb") != names.end(); // some method uses --schedule
    if (!shared && command.get_option("--schedule")->count() > 0)
        throw gi::InputError(fmt::format("--schedule with --methods {}", fmt::join(names, ",")),
                             "it applies only to 'slhb' without a schedule of its own", "leave one of them out");
}

} // namespace viewer
