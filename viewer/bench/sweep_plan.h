#pragma once
// What a sweep does, checked before it is begun.

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
    std::string name; ///< in tables and names of files
    gi::World world;
    gi::Camera camera;
};

struct SweepMethod {
    std::string name; ///< in tables: "slhb", "slhb:streamed", "vpl_imperfect:30%"
    gi::Method method;
    gi::Schedule schedule = gi::Schedule::automatic; ///< of the method slhb
    std::string quality; ///< of vpl_slhb, vpl_imperfect, vpl_ao, vpl_dao: what stands behind the colon; or empty
};

/// "slhb:streamed" is slhb with that schedule. Throws InputError naming the known methods.
SweepMethod find_sweep_method(std::string const& name, std::string const& schedule_of_all);
/// Throws InputError where a list has a value twice. @param texts  of the values
template <class T>
void refuse_twins(std::string const& option, std::vector<T> const& values, std::vector<std::string> const& texts)
{
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::find(values.begin(), values.begin() + std::ptrdiff_t(i), values[i]) !=
            values.begin() + std::ptrdiff_t(i))
            throw gi::InputError(fmt::format("{} names '{}' twice", option, texts[i]),
                                 "its rows and pictures would be mixed up", "name it once");
}
/// Those of all methods; no number of paths ends a render before its time.
gi::RenderSettings sweep_settings(RenderOptions options);
/// Loads what the options name. @param name  of the scene, in tables
SweepScene load_sweep_scene(RenderOptions const& options, std::string const& name, gi::Report& report);

/// The common settings with those that the method says itself. Throws InputError.
gi::RenderSettings settings_of(SweepMethod const& method, gi::RenderSettings common);

struct SweepPlan {
    gi::RenderSettings settings; ///< the same for all, but for budget and seed
    gi::DenoiseSettings filter;  ///< of every picture
    std::vector<double> budgets_s;
    std::vector<SweepMethod> methods;
    std::vector<SweepScene> scenes;
    std::optional<gi::Picture> reference; ///< that was given
};

/// Of the pictures of a row, without extension.
std::string picture_stem(std::string const& scene, std::string method, std::string const& budget);

/// Loads every scene. Throws InputError on all that is wrong with the call.
SweepPlan plan_sweep(SweepOptions const& options, gi::Report& report);

} // namespace viewer
