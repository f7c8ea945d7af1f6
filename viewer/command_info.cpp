#include "gi/scene/load.h"
#include "gi/scene/plan.h"
#include "gi/scene/summary.h"
#include "viewer/commands.h"
#include "viewer/report_json.h"
#include "viewer/validators.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct InfoOptions {
    std::string scene;
    std::optional<double> time_s;
    bool json = false;
};

int run(InfoOptions const& o)
{
    gi::Report report;
    auto const scene = std::make_shared<gi::Scene const>(gi::load_scene(o.scene, report));
    gi::World const world = gi::build_world(scene, o.time_s, report);
    gi::SceneSummary const summary = gi::summarise(world);
    gi::ScenePlan const plan = gi::plan_scene(world);
    if (o.json) {
        nlohmann::ordered_json j;
        j["scene"] = o.scene;
        for (gi::SummaryLine const& line : summary.lines) j["content"][line.what] = line.value;
        for (gi::PlanItem const& item : plan.items)
            j["plan"].push_back({{"what", item.what}, {"build", item.build}, {"reason", item.reason}});
        j["report"] = to_json(report);
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    fmt::print("{}\n", o.scene);
    for (gi::SummaryLine const& line : summary.lines) fmt::print("  {:<22} {}\n", line.what, line.value);
    fmt::print("What is built for it\n");
    for (gi::PlanItem const& item : plan.items)
        fmt::print("  {:<4} {:<38} {}\n", item.build ? "yes" : "no", item.what, item.reason);
    std::fflush(stdout);
    print_losses(report);
    return 0;
}

} // namespace

void add_info(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<InfoOptions>();
    CLI::App* const c = app.add_subcommand("info", "What is in a scene, what will be built for it, and why.");
    c->add_option("SCENE", o->scene, "a scene file, or atrium, cornell")->required();
    c->add_option("--time", o->time_s, "moment of the animation, s")->check(in_range(-1e9, 1e9));
    c->add_flag("--json", o->json, "print JSON");
    c->footer(R"(Examples:
  lightwell info atrium
  lightwell info cornell --json)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
