#include "python/core/render_keywords.h"

#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/methods/slhb/settings.h"
#include "python/core/errors.h"
#include "viewer/offline/render_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bindings {
namespace {

constexpr std::uint32_t kNoLimit = 0x7fffffff;
constexpr int kWidest_px = 16384;

std::int64_t whole(py::dict const& k, char const* name, double low, double high)
{
    std::int64_t value = 0;
    try {
        value = py::cast<std::int64_t>(k[name]);
    } catch (py::cast_error const&) {
        throw gi::InputError(fmt::format("{} = {}", name, std::string(py::repr(k[name]))), "it must be an integer",
                             "give one");
    }
    check_range(name, double(value), low, high);
    return value;
}

double positive(py::dict const& k, char const* name)
{
    if (k[name].is_none()) return 0;
    auto const value = py::cast<double>(k[name]);
    check_range(name, value, 1e-12, 1e9);
    return value;
}

std::string one_of(py::dict const& k, char const* name, std::vector<std::string> const& words)
{
    auto const word = py::cast<std::string>(k[name]);
    if (std::ranges::find(words, word) == words.end())
        throw gi::InputError(fmt::format("{} = '{}'", name, word), "the value is unknown",
                             fmt::format("choose from: {}", fmt::join(words, ", ")));
    return word;
}

/// Returns a command-line argument such as "--light-paths=64", for flags without a value; empty = the flag is off.
std::string argument(CLI::App const& all, std::string const& keyword, py::handle value)
{
    std::string name = "--" + keyword;
    std::ranges::replace(name, '_', '-');
    CLI::Option const* const option = all.get_option_no_throw(name);
    if (option == nullptr) {
        std::vector<std::string> known;
        for (CLI::Option const* const o : all.get_options())
            if (o->get_lnames().size() == 1 && o->get_lnames()[0] != "help") known.push_back(o->get_lnames()[0]);
        for (std::string& n : known) std::ranges::replace(n, '-', '_');
        throw gi::InputError("methods have no option '" + keyword + "'", "the keyword is unknown",
                             fmt::format("choose from: {}", fmt::join(known, ", ")));
    }
    if (option->get_items_expected_max() > 0) return name + "=" + std::string(py::str(value));
    if (!py::isinstance<py::bool_>(value))
        throw gi::InputError(keyword + " = " + std::string(py::repr(value)), "it is a flag", "give True or False");
    return py::cast<bool>(value) ? name : "";
}

/// Sets the method's options with the command line's parser and checks.
void set_options(viewer::RenderOptions& o, py::dict const& given)
{
    CLI::App all;
    viewer::declare_slhb(all, o);
    viewer::declare_virtual_lights(all, o);
    std::vector<std::string> arguments;
    for (auto const& [keyword, value] : given)
        if (auto text = argument(all, py::cast<std::string>(keyword), value); !text.empty())
            arguments.push_back(std::move(text));
    try {
        all.parse(arguments);
    } catch (CLI::ParseError const& e) {
        throw gi::InputError(e.what(), "the option has other values", "see lightwell render --help");
    }
    std::vector<viewer::NamedMethod> const methods{
        {o.method, gi::parse_schedule(o.schedule), "--schedule " + o.schedule}};
    check_slhb(all, methods);
    check_virtual_lights(all, methods);
}

} // namespace

gi::RenderSettings settings_of(py::dict const& k, py::dict const& options, std::string const& method)
{
    viewer::RenderOptions o;
    o.method = method;
    o.size = fmt::format("{}x{}", whole(k, "width", 1, kWidest_px), whole(k, "height", 1, kWidest_px));
    if (!k["paths"].is_none()) o.paths = std::uint32_t(whole(k, "paths", 1, kNoLimit));
    o.bounces = int(whole(k, "bounces", 0, 1000));
    o.seed = std::uint64_t(whole(k, "seed", 0, 9e18));
    o.threads = int(whole(k, "threads", 0, 4096));
    o.filter = one_of(k, "filter", {"box", "tent"});
    o.png = "in memory"; // so that no output or checkpoint file is chosen
    set_options(o, options);
    gi::RenderSettings s = viewer::make_settings(o);
    s.budget_s = positive(k, "budget_s");
    s.until_relmse = positive(k, "until_relmse");
    if (!o.paths && (s.budget_s > 0 || s.until_relmse > 0)) s.paths = kNoLimit;
    return s;
}

gi::DenoiseSettings denoise_of(std::string const& name, gi::RenderSettings const& settings)
{
    py::dict k;
    k["denoise"] = name;
    viewer::RenderOptions o;
    o.denoise = one_of(k, "denoise", gi::filter_names());
    return viewer::make_denoise_settings(o, settings);
}

} // namespace bindings
