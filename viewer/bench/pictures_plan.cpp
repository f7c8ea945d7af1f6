#include "viewer/bench/pictures_plan.h"

#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/text.h"
#include "gi/filter/filter_names.h"
#include "viewer/base/arguments.h"
#include "viewer/bench/bench_record.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>

namespace viewer {
namespace {

/// Throws InputError if the filter cannot work here, as a library or its weights are missing.
void try_filter(gi::DenoiseSettings const& settings)
{
    if (settings.denoiser == gi::Denoiser::none) return;
    constexpr int kSide = 8;
    gi::Picture picture{kSide, kSide, {}, {}};
    for (char const* layer : {"color", "L0", "L1", "L2", "albedo", "normal", "position", "variance"})
        picture.add(layer, 3);
    picture.add("depth", 1);
    gi::denoise(picture, settings);
}

/// Adds a filter; known filters that cannot work here are skipped.
void add_filter(PicturesOptions const& o, std::string const& name, PicturesPlan& plan)
{
    RenderOptions options = o.render;
    options.denoise = name;
    gi::find_filter(name); // throws
    try {
        gi::DenoiseSettings const settings = make_denoise_settings(options, plan.settings);
        try_filter(settings);
        plan.filters.push_back({name, settings});
    } catch (gi::InputError const& e) {
        plan.skipped.push_back({"filter " + name, e.what()});
    }
}

Listed kind_of(PicturesOptions const& o) { return o.interactive ? Listed::sequences : Listed::scenes; }

/// Reads the list; without it, scenes can still be named one by one.
std::vector<ListedScene> scene_list(PicturesOptions const& o)
{
    std::error_code error;
    if (std::filesystem::exists(o.list, error)) return read_scene_list(o.list, o.render, kind_of(o));
    if (!o.scenes.empty() && o.list == PicturesOptions().list) return {};
    throw gi::InputError("there is no list of scenes '" + o.list + "'", "the scenes to render are not known",
                         "start in the repository's folder, or name scenes with --scenes or a list with --list");
}

} // namespace

PictureBudget parse_picture_budget(std::string const& text)
{
    std::string_view digits = text;
    for (std::string_view const unit : {"paths", "path"})
        if (digits.ends_with(unit)) {
            digits.remove_suffix(unit.size());
            auto const paths = gi::parse_number<std::uint32_t>(digits);
            constexpr std::uint32_t kMost = 1 << 24;
            if (!paths || *paths < 1 || *paths > kMost)
                throw gi::InputError("--budgets " + text, "it is not a number of paths",
                                     fmt::format("write 1path to {}paths", kMost));
            return {text, 0, *paths};
        }
    return {text, parse_duration("--budgets", text), 0};
}

std::filesystem::path reference_folder(PicturesOptions const& o)
{
    std::filesystem::path const folder =
        o.references.empty() ? std::filesystem::path(o.out) / "references" : std::filesystem::path(o.references);
    gi::make_folder(folder.string());
    return folder;
}

std::vector<std::pair<std::string, std::string>> common_facts(PicturesOptions const& o, PicturesPlan const& plan)
{
    gi::RenderSettings const& s = plan.settings;
    return {{"size", fmt::format("{}x{}", s.width, s.height)},
            {"bounces", std::to_string(s.bounces)},
            {"threads", s.threads == 0 ? "all" : std::to_string(s.threads)},
            {"seeds", fmt::format("{} and following, one per repeat", s.seed)},
            {"repeats", std::to_string(o.repeats)},
            {"reference", fmt::format("path tracing, {} paths per pixel", o.reference_paths)}};
}

void skip(Skipped const& s, BenchTable& table)
{
    std::fputs(fmt::format("note: skipped: {}: {}\n", s.what, s.why).c_str(), stderr);
    table.facts.emplace_back("skipped: " + s.what, s.why);
}

PicturesPlan plan_pictures(PicturesOptions const& o)
{
    PicturesPlan plan;
    for (std::string const& name : o.methods) plan.methods.push_back(find_sweep_method(name));
    refuse_twins("--methods", o.methods, o.methods);
    for (std::string const& text : o.budgets) plan.budgets.push_back(parse_picture_budget(text));
    refuse_twins("--budgets", o.budgets, o.budgets);
    refuse_twins("--scenes", o.scenes, o.scenes);
    plan.settings = sweep_settings(o.render);
    for (SweepMethod const& m : plan.methods) settings_of(m, plan.settings);
    refuse_twins("--denoise", o.filters, o.filters);
    for (std::string const& name : o.filters) add_filter(o, name, plan);
    if (plan.filters.empty())
        throw gi::InputError("no filter of --denoise is available", plan.skipped.front().why, "add the filter 'none'");
    for (ListedScene& scene : choose_scenes(scene_list(o), o.scenes, o.render)) {
        if (scene.missing.empty())
            plan.scenes.push_back(std::move(scene));
        else
            plan.skipped.push_back({"scene " + scene.name, "there is no file '" + scene.missing + "'"});
    }
    if (plan.scenes.empty())
        throw gi::InputError("no scene of '" + o.list + "' can be rendered",
                             plan.skipped.front().what + ": " + plan.skipped.front().why,
                             "get its files, or name another scene with --scenes");
    check_folder(o.out);
    if (!o.references.empty()) check_folder(o.references);
    return plan;
}

} // namespace viewer
