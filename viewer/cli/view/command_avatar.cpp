#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/avatar.h"
#include "gi/scene/motion/avatar_proposal.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

int run_map(std::string const& file, std::string const& out)
{
    check_outputs({out}, {file});
    gi::Report report;
    if (file != "avatar" && !std::filesystem::exists(file))
        throw gi::InputError("there is no avatar '" + file + "'", "no such file",
                             "give a skinned model, or avatar (built in)");
    gi::Scene const scene = gi::load_scene(file, report);
    gi::AvatarProposal const proposal = gi::propose_avatar_joints(scene);
    gi::make_avatar(scene, proposal.joints); // throws if it could not be moved
    std::string const text = gi::to_avatar_map(scene, proposal, std::filesystem::path(file).filename().string());
    if (out.empty()) {
        std::fputs(text.c_str(), stdout);
    } else {
        gi::write_text(out, text);
        fmt::print("{}\n", out);
    }
    std::fflush(stdout);
    print_losses(report);
    return 0;
}

} // namespace

void add_avatar(CLI::App& app, int& exit_code)
{
    auto const file = std::make_shared<std::string>(), out = std::make_shared<std::string>();
    CLI::App* const avatar = app.add_subcommand("avatar", about("avatar"));
    avatar->require_subcommand(1);
    CLI::App* const map = avatar->add_subcommand(
        "map", "Propose which joints of a model are head, arms and legs, for view --avatar-joints.");
    map->add_option("FILE", *file, "skinned model, or avatar (built in)")->required();
    map->add_option("-o,--out", *out, "joint map to write (YAML); default: print it");
    map->callback([file, out, &exit_code] { exit_code = run_map(*file, *out); });
    char const* const examples = R"(Examples:
  lightwell avatar map avatar
  lightwell avatar map avatar --out joints.yaml

Read the reasons in the file, and correct it where they are wrong: left is the avatar's own left.
Nodes without a name of their own are written as "#" and their number.)";
    map->footer(examples);
    avatar->footer(examples);
}

} // namespace viewer
