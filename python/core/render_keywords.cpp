#include "python/core/render_keywords.h"

#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/kernel/device.h"
#include "gi/methods/registry.h"
#include "python/core/errors.h"

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

void set(gi::RenderSettings& s, gi::RenderOption const& option, std::string const& keyword, py::handle value)
{
    bool const is_bool = py::isinstance<py::bool_>(value);
    std::string const text = is_bool ? (py::cast<bool>(value) ? "true" : "false") : std::string(py::str(value));
    option.set(s, text, fmt::format("{} = {}", keyword, std::string(py::repr(value))));
}

/// Sets the method's options, which the method must read.
void set_options(gi::RenderSettings& s, py::dict const& options, std::string const& method)
{
    std::vector<std::string> given, known;
    for (gi::RenderOption const& o : gi::render_options())
        if (!o.methods.empty() && o.replaced_by.empty()) known.push_back(o.key);
    for (auto const& [key, value] : options) {
        auto const keyword = py::cast<std::string>(key);
        gi::RenderOption const* const option = gi::find_render_option(keyword);
        if (option == nullptr)
            throw gi::InputError("methods have no option '" + keyword + "'", "the keyword is unknown",
                                 fmt::format("choose from: {}", fmt::join(known, ", ")));
        set(s, *option, keyword, value);
        bool const is_off = py::isinstance<py::bool_>(value) && !py::cast<bool>(value);
        if (!is_off) given.push_back(option->name);
    }
    gi::check_options(given, {{method, s}});
    gi::check_device(s.space);
}

} // namespace

gi::RenderSettings settings_of(py::dict const& k, py::dict const& options, std::string const& method)
{
    gi::RenderSettings s;
    s.width = int(whole(k, "width", 1, kWidest_px));
    s.height = int(whole(k, "height", 1, kWidest_px));
    gi::check_picture_size(s.width, s.height);
    for (char const* const name : {"bounces", "seed", "threads", "filter"})
        set(s, gi::render_option(name), name, k[name]);
    set_options(s, options, method);
    s.budget_s = positive(k, "budget_s");
    s.until_relmse = positive(k, "until_relmse");
    if (!k["paths"].is_none())
        s.paths = std::uint32_t(whole(k, "paths", 1, kNoLimit));
    else if (s.budget_s > 0 || s.until_relmse > 0)
        s.paths = kNoLimit;
    s.checkpoint = py::cast<std::string>(k["state"]);
    s.resume = py::cast<bool>(k["resume"]);
    if (s.resume && s.checkpoint.empty())
        throw gi::InputError("resume=True without a state", "it is not known what to continue", "give state=FILE");
    s.checkpoint_s = py::cast<double>(k["checkpoint_s"]);
    check_range("checkpoint_s", s.checkpoint_s, 0, 1e9);
    return s;
}

gi::DenoiseSettings denoise_of(std::string const& name, gi::RenderSettings const& settings)
{
    gi::DenoiseSettings d = gi::find_filter(name);
    gi::check_filter(d, settings.paths, false);
    d.threads = settings.threads;
    return d;
}

} // namespace bindings
