#pragma once
// Plan of a sweep, checked before rendering.

#include "gi/core/error.h"
#include "gi/filter/denoise.h"
#include "gi/methods/registry.h"
#include "viewer/bench/sweep.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace viewer {

struct SweepScene {
    RenderOptions options;
    std::string name; ///< for tables and file names
    gi::World world;
    gi::Camera camera;
};

struct SweepMethod {
    std::string name; ///< for tables: "slhb", "slhb:streamed", "vpl_imperfect:30%"
    gi::Method method;
    gi::RenderOption const* option = nullptr; ///< that the text after the colon sets; nullptr if there is none
    std::string value;
};

/// Parses a method; "slhb:streamed" is slhb with that schedule. Throws InputError listing the known methods.
SweepMethod find_sweep_method(std::string const& name);
/// Throws InputError if a list has a value twice. @param texts  the values as given
template <class T>
void refuse_twins(std::string const& option, std::vector<T> const& values, std::vector<std::string> const& texts)
{
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::find(values.begin(), values.begin() + std::ptrdiff_t(i), values[i]) !=
            values.begin() + std::ptrdiff_t(i))
            throw gi::InputError(fmt::format("{} names '{}' twice", option, texts[i]),
                                 "its rows and pictures would be mixed up", "name it once");
}
/// Common settings of all methods, with no limit on paths, so that only the budget ends a render.
gi::RenderSettings sweep_settings(RenderOptions options);
/// Loads the scene of the options. @param name  name of the scene in tables
SweepScene load_sweep_scene(RenderOptions const& options, std::string const& name, gi::Report& report);

/// The common settings, with those given in the name of the method. Throws InputError.
gi::RenderSettings settings_of(SweepMethod const& method, gi::RenderSettings common);

/// Throws InputError if options are given that none of the methods of a sweep ("slhb:streamed", "vpl_ao:0.5")
/// uses.
void check_sweep_methods(CLI::App const& command, RenderOptions const& options,
                         std::vector<std::string> const& names);

struct SweepPlan {
    gi::RenderSettings settings; ///< common to all renders, except budget and seed
    gi::DenoiseSettings filter;  ///< applied to every picture
    std::vector<double> budgets_s;
    std::vector<SweepMethod> methods;
    std::vector<SweepScene> scenes;
    std::optional<gi::Picture> reference; ///< of --reference, if given
};

/// File name of the pictures of a row, without extension.
std::string picture_stem(std::string const& scene, std::string method, std::string const& budget);

/// Makes the plan and loads every scene. Throws InputError if the call is invalid.
SweepPlan plan_sweep(SweepOptions const& options, gi::Report& report);

} // namespace viewer
