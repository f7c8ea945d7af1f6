#include "viewer/bench/sweep_plan.h"

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "gi/methods/registry.h"
#include "viewer/base/arguments.h"
#include "viewer/base/outputs.h"
#include "viewer/bench/bench_record.h"
#include "viewer/offline/load_world.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {
namespace {

gi::Picture read_reference(std::string const& file, gi::RenderSettings const& s, gi::Report& report)
{
    gi::Picture picture = gi::read_picture(file);
    gi::color_of(picture, file); // throws without one
    for (std::string const& note : picture.notes)
        report.lose("references not used as they are", 1, file + ": " + note);
    if (picture.width != s.width || picture.height != s.height)
        throw gi::InputError(fmt::format("'{}' is {}x{}", file, picture.width, picture.height),
                             fmt::format("the pictures to compare are {}x{}", s.width, s.height),
                             fmt::format("add --size {}x{}", picture.width, picture.height));
    return picture;
}

/// A sweep may replace outputs of an earlier one, but not its own inputs.
void check_pictures(SweepOptions const& o, std::vector<std::string> const& names,
                    std::vector<std::string> const& inputs)
{
    if (!std::filesystem::exists(o.out)) return;
    std::vector<std::string> files;
    for (std::string const& scene : names)
        for (std::string const& method : o.methods)
            for (std::string const& budget : o.budgets)
                for (char const* end : {".exr", ".png", "_flip.png"})
                    files.push_back(
                        (std::filesystem::path(o.out) / (picture_stem(scene, method, budget) + end)).string());
    check_outputs(files, inputs);
}

} // namespace

SweepMethod find_sweep_method(std::string const& name)
{
    std::size_t const colon = name.find(':');
    gi::Method const& method = gi::find_method(name.substr(0, colon));
    if (colon == std::string::npos) return {name, method, nullptr, ""};
    if (!method.variant.empty())
        return {name, method, &gi::render_option(method.variant), name.substr(colon + 1)};
    throw gi::InputError(fmt::format("--methods {}: '{}' has no variants", name, method.name),
                         "nothing may follow the name of this method", fmt::format("name it '{}'", method.name));
}

gi::RenderSettings sweep_settings(RenderOptions options)
{
    options.budget = "1s";
    options.png = "unused";
    return make_settings(options);
}

SweepScene load_sweep_scene(RenderOptions const& options, std::string const& name, gi::Report& report)
{
    gi::World world = load_world(options, report);
    ChosenCamera const chosen = choose_camera(world, camera_choice(options));
    if (!chosen.note.empty()) std::fputs(fmt::format("note: {}: {}\n", name, chosen.note).c_str(), stderr);
    return {options, name, std::move(world), chosen.camera};
}

std::string picture_stem(std::string const& scene, std::string method, std::string const& budget)
{
    std::ranges::replace(method, ':', '-');
    std::ranges::replace(method, '%', 'p');
    return fmt::format("{}_{}_{}", scene, method, budget);
}

gi::RenderSettings settings_of(SweepMethod const& m, gi::RenderSettings s)
{
    if (m.option != nullptr) m.option->set(s, m.value, "--methods " + m.name);
    return s;
}

void check_sweep_methods(CLI::App const& command, RenderOptions const& options,
                         std::vector<std::string> const& names)
{
    std::vector<gi::ChosenMethod> methods;
    gi::RenderOption const& schedule = gi::render_option("schedule");
    bool shared = false; // some method uses --schedule
    for (std::string const& name : names) {
        SweepMethod const m = find_sweep_method(name);
        bool const own_schedule = m.option == &schedule;
        methods.push_back({std::string(m.method.name), settings_of(m, options.settings),
                           own_schedule ? "--methods " + name : ""});
        shared |= !own_schedule && schedule.read_by(m.method.name);
    }
    check_method_options(command, methods);
    if (!shared && command.get_option("--schedule")->count() > 0)
        throw gi::InputError(fmt::format("--schedule with --methods {}", fmt::join(names, ",")),
                             "it applies only to methods with schedules that are not named with one",
                             "leave one of them out");
}

SweepPlan plan_sweep(SweepOptions const& o, gi::Report& report)
{
    SweepPlan plan;
    for (std::string const& name : o.methods) plan.methods.push_back(find_sweep_method(name));
    refuse_twins("--methods", o.methods, o.methods);
    for (std::string const& text : o.budgets) plan.budgets_s.push_back(parse_duration("--budgets", text));
    refuse_twins("--budgets", plan.budgets_s, o.budgets);
    std::vector<std::string> names;
    for (std::string const& scene : o.scenes) names.push_back(std::filesystem::path(scene).stem().string());
    refuse_twins("--scene", names, names);
    plan.settings = sweep_settings(o.render);
    for (SweepMethod const& m : plan.methods) settings_of(m, plan.settings);
    plan.filter = make_denoise_settings(o.render, plan.settings);
    camera_choice(o.render); // throws before anything is loaded
    if (!o.reference.empty() && o.scenes.size() > 1)
        throw gi::InputError("--reference is given for several scenes", "one picture does not fit all of them",
                             "sweep one scene at a time, or drop it");
    check_folder(o.out);
    std::vector<std::string> inputs = o.scenes;
    inputs.insert(inputs.end(), {o.reference, o.render.environment});
    check_pictures(o, names, inputs);
    if (!o.reference.empty()) plan.reference = read_reference(o.reference, plan.settings, report);
    for (std::size_t i = 0; i < names.size(); ++i) {
        RenderOptions options = o.render;
        options.scene = o.scenes[i];
        plan.scenes.push_back(load_sweep_scene(options, names[i], report));
    }
    for (SweepScene const& scene : plan.scenes) check_pictures(o, names, scene.world.scene->files);
    return plan;
}

} // namespace viewer
