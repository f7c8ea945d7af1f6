#include "gi/methods/options.h"

#include "gi/core/error.h"
#include "gi/methods/registry.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gi {
namespace {

/// Why a method that reads the option with some schedule does not with its own; nullptr if it does.
char const* why_unused(RenderOption const& option, ChosenMethod const& method)
{
    for (UnusedBy const& u : option.use.unused_by)
        if (u.schedule == method.schedule && reads(method.name, render_option("schedule"))) return u.why;
    return nullptr;
}

void check_used(RenderOption const& option, std::vector<ChosenMethod> const& methods)
{
    ChosenMethod const* reader = nullptr;
    for (ChosenMethod const& m : methods) {
        if (!reads(m.name, option)) continue;
        if (why_unused(option, m) == nullptr) return;
        if (reader == nullptr) reader = &m;
    }
    if (reader == nullptr)
        throw InputError(fmt::format("--{} with --method {}", option.name, methods.front().name),
                         fmt::format("it applies to {}", fmt::join(option.use.methods, " and ")),
                         "add such a method, or leave it out");
    throw InputError(fmt::format("--{} with {}", option.name, reader->as_given), why_unused(option, *reader),
                     "leave one of them out");
}

} // namespace

RenderOptionTable const& render_options()
{
    static RenderOptionTable const all = [] {
        RenderOptionTable table = common_options();
        std::vector<RenderOptionTable const*> added;
        for (Method const& m : methods()) {
            if (m.options == nullptr || std::ranges::find(added, &m.options()) != added.end()) continue;
            added.push_back(&m.options());
            table.insert(table.end(), m.options().begin(), m.options().end());
        }
        return table;
    }();
    return all;
}

RenderOption const* find_render_option(std::string_view name)
{
    for (RenderOption const& o : render_options())
        if (is_called(o, name)) return &o;
    return nullptr;
}

RenderOption const& render_option(std::string_view name) { return *find_render_option(name); }

void check_options(std::vector<std::string> const& given, RenderSettings const& settings,
                   std::vector<ChosenMethod> const& methods)
{
    auto const is_given = [&](char const* name) { return std::ranges::find(given, name) != given.end(); };
    for (std::string const& name : given) check_used(render_option(name), methods);
    bool const any_schedule = std::ranges::none_of(
        methods, [](ChosenMethod const& m) { return m.name == "slhb" && m.schedule != Schedule::automatic; });
    if (any_schedule && is_given("directions") && (is_given("axes") || is_given("fresh-axes")))
        throw InputError("--directions with --axes or --fresh-axes",
                         "only the stored schedule uses --directions, only the others draw axes",
                         "leave one of them out");
    SlhbSettings const& s = settings.slhb;
    auto const check_part = [](char const* part, int fresh, char const* whole, int all) {
        if (all > 0 && fresh > all)
            throw InputError(fmt::format("{} is larger than {}", part, whole), "it is the part that is new",
                             fmt::format("give at most {}", all));
    };
    check_part("--fresh-axes", s.fresh_axes, "--axes", s.axes);
    check_part("--fresh-light-samples", s.fresh_light_samples, "--light-samples", s.light_samples);
}

} // namespace gi
