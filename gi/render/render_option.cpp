#include "gi/render/render_option.h"

#include "gi/core/error.h"
#include "gi/core/shell.h"

#include <algorithm>
#include <fmt/format.h>
#include <unistd.h>

namespace gi {

bool RenderOption::read_by(std::string_view method) const
{
    auto const fits = [&](std::string_view m) {
        return m.ends_with('*') ? method.starts_with(m.substr(0, m.size() - 1)) : method == m;
    };
    return methods.empty() || std::ranges::any_of(methods, fits);
}

std::string as_options(RenderOptionTable const& table, RenderSettings const& settings,
                       std::vector<std::string_view> const& names)
{
    std::string all;
    for (std::string_view const name : names)
        for (RenderOption const& o : table) {
            if (o.name != name) continue;
            std::string const value = o.get(settings);
            bool const flag = o.type == OptionType::yes_or_no;
            if (flag && value == "false") continue;
            all += (all.empty() ? "--" : " --") + o.name + (flag ? "" : " " + shell_quoted(value));
        }
    return all;
}

RenderOptionTable const& common_options()
{
    using S = RenderSettings;
    auto const common = [](char const* name, OptionValues values, char const* meaning, auto S::*member) {
        return RenderOption{
            make_option<S>(
                name, std::move(values), meaning, [member](auto& s) -> auto& { return s.*member; }),
            "",
            {}};
    };
    static RenderOptionTable const all = [&] {
        RenderOptionTable table{
            common("bounces", {0, 1024}, "indirect bounces; 0 = direct light only; mirrors and glass do not count",
                   &S::bounces),
            common("filter", {"box", "tent"}, "pixel filter: box, one pixel wide; tent, a radius of one pixel",
                   &S::filter),
            common("seed", {0, 0x1p64}, "seed of the random numbers", &S::seed),
            common("threads", {0, 4096}, "threads; 0 = all", &S::threads),
        };
        table.back().live = false;
        RenderOption device = common(
            "device", {"cpu", "cuda"},
            "of methods that have kernels: cpu; or cuda: everything on the GPU, also --reuse and --shutter", &S::space);
        device.methods = {"auto", "paths", "reference", "slhb", "slhb_0_1"};
        table.push_back(std::move(device));
        return table;
    }();
    return all;
}

std::string changed_options(RenderOptionTable const& table, RenderSettings const& settings,
                            std::vector<std::string_view> names)
{
    for (RenderOption const& o : table)
        if (std::ranges::find(names, o.name) == names.end() && o.get(settings) != o.get(RenderSettings{}))
            names.push_back(o.name);
    return as_options(table, settings, names);
}

void check_picture_size(int width, int height)
{
    constexpr double kBytesPerPixel = 300; // sums in double and all layers in float
    double const needed = kBytesPerPixel * width * height;
    double const there = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
    if (needed > there)
        throw InputError(
            fmt::format("--size {}x{} is too large", width, height),
            fmt::format("it needs about {:.0f} GB of memory, and there are {:.0f}", needed * 1e-9, there * 1e-9),
            "choose a smaller one");
}

} // namespace gi
