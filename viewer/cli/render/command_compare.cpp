#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "gi/metrics/compare.h"
#include "viewer/base/arguments.h"
#include "viewer/base/choices.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct CompareOptions {
    std::string image, reference, layer = "color", difference;
    std::vector<std::string> metrics, limits;
    bool json = false;
};

int run(CompareOptions const& o)
{
    check_ending(o.difference, ".png", "a PNG", "end it with .png");
    check_outputs({o.difference}, {o.image, o.reference});
    gi::Picture const image = gi::read_picture(o.image), reference = gi::read_picture(o.reference);
    std::vector<std::pair<std::string, double>> limits;
    std::vector<std::string> names = o.metrics;
    for (std::string const& text : o.limits) {
        limits.push_back(parse_limit("--fail-above", text));
        std::string const metric = limits.back().first.substr(0, limits.back().first.find('.'));
        if (!o.metrics.empty() && std::find(names.begin(), names.end(), metric) == names.end())
            names.push_back(metric);
    }
    if (names.empty())
        for (gi::MetricInfo const& m : gi::metrics())
            if (m.by_default || std::any_of(limits.begin(), limits.end(),
                                            [&](auto const& l) { return l.first.starts_with(m.name); }))
                names.emplace_back(m.name);
    gi::Comparison const result = gi::compare(image, reference, names, o.layer);
    for (auto const& [name, value] : limits)
        if (std::none_of(result.values.begin(), result.values.end(),
                         [&, wanted = name](auto const& v) { return v.name == wanted; }))
            throw gi::InputError("--fail-above knows no '" + name + "'", "no metric gives a value with this name",
                                 "use a name that compare prints");
    if (!o.difference.empty()) {
        int width = 0, height = 0;
        auto const pixels = gi::difference_image(image, reference, o.layer, width, height);
        gi::write_png(o.difference, width, height, pixels);
    }

    std::vector<std::string> failures;
    for (auto const& [name, limit] : limits)
        for (gi::NamedValue const& v : result.values)
            if (v.name == name && !(v.value <= limit))
                failures.push_back(fmt::format("{} is {:.6g}, above {:.6g}", name, v.value, limit));
    if (o.json) {
        nlohmann::ordered_json j;
        j["image"] = o.image;
        j["reference"] = o.reference;
        j["layer"] = o.layer;
        for (gi::NamedValue const& v : result.values)
            if (std::isfinite(v.value))
                j["values"][v.name] = v.value;
            else
                j["values"][v.name] = fmt::format("{}", v.value); // JSON has no infinity
        j["notes"] = result.notes;
        j["failures"] = failures;
        std::fputs(to_text(j).c_str(), stdout);
    } else {
        for (gi::NamedValue const& v : result.values) fmt::print("{:<16} {:.6g}\n", v.name, v.value);
        for (std::string const& n : result.notes) std::fputs(("note: " + n + "\n").c_str(), stderr);
    }
    for (std::string const& f : failures) std::fputs(("failed: " + f + "\n").c_str(), stderr);
    return failures.empty() ? 0 : 1;
}

} // namespace

void add_compare(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<CompareOptions>();
    CLI::App* const c = app.add_subcommand("compare", about("compare"));
    c->add_option("IMAGE", o->image, "EXR, HDR, PNG, JPEG, ...")->required();
    c->add_option("REFERENCE", o->reference, "reference; may be an integer factor larger or smaller")->required();
    std::string known;
    std::vector<std::string> names;
    for (gi::MetricInfo const& m : gi::metrics()) {
        known += fmt::format("\n  {}: {}", m.name, m.meaning);
        names.emplace_back(m.name);
    }
    offer(c->add_option("--metrics", o->metrics, "comma-separated; known metrics:" + known), names)
        ->delimiter(',')
        ->allow_extra_args(false);
    c->add_option("--layer", o->layer, "layer to compare")->capture_default_str();
    c->add_option("--fail-above", o->limits, "NAME=LIMIT: exit with code 1 if this value is larger")
        ->delimiter(',')
        ->allow_extra_args(false);
    c->add_option("--diff", o->difference, "map of the FLIP error to write (.png); black = no error");
    c->add_flag("--json", o->json, "print JSON");
    c->footer(R"(Prepared by:
  lightwell render cornell --size 64x64 --paths 16 --out a.exr
  lightwell render cornell --size 64x64 --paths 64 --seed 1 --out b.exr
Examples:
  lightwell compare a.exr b.exr --metrics relmse,bias,ztest --diff difference.png
  lightwell compare a.exr b.exr --layer L1 --fail-above flip=0.5 --json)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
