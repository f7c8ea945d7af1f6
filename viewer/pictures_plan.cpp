#include "viewer/pictures_plan.h"

#include "gi/base/error.h"
#include "viewer/arguments.h"
#include "viewer/bench_record.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <fmt/format.h>

namespace viewer {
namespace {

/// By the option --denoise itself, so that both know the same filters.
void choose_filter(std::string const& name, RenderOptions& options)
{
    CLI::App parser;
    declare_denoise(parser, options);
    try {
        parser.parse(std::vector<std::string>{"--denoise=" + name});
    } catch (CLI::ParseError const& e) {
        throw gi::InputError("there is no filter '" + name + "'", e.what(), "see lightwell render --help");
    }
}

/// A filter that is known but cannot work here is skipped.
void add_filter(PicturesOptions const& o, std::string const& name, PicturesPlan& plan)
{
    RenderOptions options = o.render;
    choose_filter(name, options);
    try {
        plan.filters.push_back({name, make_denoise_settings(options, plan.settings)});
    } catch (gi::InputError const& e) {
        plan.skipped.push_back({"filter " + name, e.what()});
    }
}

} // namespace

PictureBudget parse_picture_budget(std::string const& text)
{
    std::string_view digits = text;
    for (std::string_view const unit : {"paths", "path"})
        if (digits.ends_with(unit)) {
            digits.remove_suffix(unit.size());
            std::uint32_t paths = 0;
            auto const [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), paths);
            constexpr std::uint32_t kMost = 1 << 24;
            if (error != std::errc() || end != digits.data() + digits.size() || paths < 1 || paths > kMost)
                throw gi::InputError("--budgets " + text, "it is no number of paths",
                                     fmt::format("write 1path to {}paths", kMost));
            return {text, 0, paths};
        }
    return {text, parse_duration("--budgets", text), 0};
}

PicturesPlan plan_pictures(PicturesOptions const& o)
{
    PicturesPlan plan;
    for (std::string const& name : o.methods) plan.methods.push_back(find_sweep_method(name, o.render.schedule));
    refuse_twins("--methods", o.methods, o.methods);
    for (std::string const& text : o.budgets) plan.budgets.push_back(parse_picture_budget(text));
    refuse_twins("--budgets", o.budgets, o.budgets);
    refuse_twins("--scenes", o.scenes, o.scenes);
    plan.settings = sweep_settings(o.render);
    for (SweepMethod const& m : plan.methods) settings_of(m, plan.settings);
    refuse_twins("--denoise", o.filters, o.filters);
    for (std::string const& name : o.filters) add_filter(o, name, plan);
    if (plan.filters.empty())
        throw gi::InputError("no filter of --denoise is available", plan.skipped.front().why, "add none");
    std::error_code error;
    if (!std::filesystem::exists(o.list, error))
        throw gi::InputError("there is no list of scenes '" + o.list + "'", "--list names it",
                             "start in the repository's folder, or name another");
    for (ListedScene& scene : choose_scenes(read_scene_list(o.list, o.render), o.scenes)) {
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
