#include "viewer/cli/program.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/core/progress.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/version.h"
#include "viewer/cli/command_table.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <malloc.h>
#include <new>
#include <stdexcept>

namespace viewer {
namespace {

/// Names of the given subcommands, e.g. "track listen ".
std::string path_of_given(CLI::App const& app)
{
    std::string path;
    for (auto given = app.get_subcommands(); !given.empty(); given = given.back()->get_subcommands())
        path += given.back()->get_name() + " ";
    return path;
}

/// "did you mean 'render'? ", or empty if no known word is close.
std::string suggest(std::string const& word, std::vector<std::string> const& known)
{
    int least = 3;
    std::string nearest;
    for (std::string const& name : known)
        if (int const distance = gi::edit_distance(word, name); distance < std::min(least, int(word.size()) / 2)) {
            least = distance;
            nearest = name;
        }
    return nearest.empty() ? "" : "did you mean '" + nearest + "'? ";
}

std::vector<std::string> subcommands_of(CLI::App const& app)
{
    std::vector<std::string> names;
    for (CLI::App const* const s : app.get_subcommands([](CLI::App const*) { return true; }))
        names.push_back(s->get_name());
    return names;
}

std::vector<std::string> options_of(CLI::App const& app)
{
    std::vector<std::string> names;
    for (CLI::Option const* const o : app.get_options())
        for (std::string const& name : o->get_lnames()) names.push_back("--" + name);
    return names;
}

/// Error message for an invalid call. Unknown words are reported before missing arguments.
std::string describe(CLI::ParseError const& e, CLI::App const& app)
{
    std::string const misfit = " (the call is not valid) ";
    bool const may_be_unknown = dynamic_cast<CLI::ExtrasError const*>(&e) != nullptr ||
                                dynamic_cast<CLI::RequiredError const*>(&e) != nullptr;
    for (CLI::App const* a = &app; may_be_unknown && a != nullptr;) {
        auto const given = a->get_subcommands();
        if (std::vector<std::string> const unknown = a->remaining(); !unknown.empty()) {
            std::string const word =
                unknown.front().substr(0, std::min<std::size_t>(64, unknown.front().find('=')));
            if (!word.starts_with('-') && given.empty() && a->get_require_subcommand_min() > 0)
                return "there is no subcommand '" + word + "'" + misfit + suggest(word, subcommands_of(*a));
            return "'" + word + "' was not expected" + misfit + suggest(word, options_of(*a));
        }
        a = given.empty() ? nullptr : given.back();
    }
    return e.what() + misfit;
}

} // namespace

void add_elsewhere(CLI::App& parent, CommandRow const& c)
{
    CLI::App* const stub =
        parent.add_subcommand(std::string(c.name.substr(c.name.find(' ') + 1)), std::string(c.about));
    stub->callback([stub, name = std::string(c.name), program = std::string(c.program)] {
        if (stub->get_subcommands().empty())
            throw gi::InputError("'" + name + "' is not in this program", program + " has it",
                                 "call lightwell " + name);
    });
}

namespace {

/// Adds all commands of the table, so that every program lists them; those of other programs are stubs.
void add_commands(CLI::App& app, std::span<AddedCommand const> own, int& exit_code)
{
    for (CommandRow const& c : commands()) {
        std::size_t const space = c.name.find(' ');
        auto const mine =
            std::find_if(own.begin(), own.end(), [&](AddedCommand const& a) { return a.name == c.name; });
        CLI::App& parent = space == c.name.npos ? app : *app.get_subcommand(std::string(c.name.substr(0, space)));
        if (mine != own.end())
            mine->add(parent, exit_code);
        else if (space == c.name.npos)
            add_elsewhere(parent, c);
    }
}

} // namespace

int run_program(int argc, char const* const* argv, std::span<AddedCommand const> own)
{
    // Keep freed memory: each frame needs the same amount, and mapping it anew takes a quarter of a short frame.
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, 64 << 20);
    mallopt(M_ARENA_MAX, 2); // as each arena keeps its peak memory
    CLI::App app{"Lightwell: renders global illumination and measures its error."};
    app.set_version_flag("--version", version_text());
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    app.footer(R"(Examples:
  lightwell render atrium --size 160x100 --paths 16 --out atrium.exr --png atrium.png
  lightwell info atrium
  lightwell generate boxes --triangles 20000 --out boxes.glb

Exit codes: 0 done, 1 a comparison failed or not all outputs could be written, 2 the input or the call is wrong,
130 interrupted. Ctrl-C in `view` exits cleanly with code 0.)");
    setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0); // silent: this program reports errors itself
    int exit_code = 0;
    add_commands(app, own, exit_code);
    try {
        app.parse(argc, argv);
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            throw std::runtime_error("standard output could not be written");
        return exit_code;
    } catch (CLI::Success const& e) { // --help and --version
        return app.exit(e);
    } catch (CLI::ParseError const& e) {
        std::fputs(
            fmt::format("lightwell: {}see lightwell {}--help\n", describe(e, app), path_of_given(app)).c_str(),
            stderr);
        return 2;
    } catch (gi::InputError const& e) {
        std::fputs(fmt::format("lightwell: {}\n", e.what()).c_str(), stderr);
        return 2;
    } catch (gi::Interrupted const&) {
        std::fputs("lightwell: interrupted before a picture was rendered\n", stderr);
        return kInterrupted;
    } catch (std::bad_alloc const&) {
        std::fputs("lightwell: out of memory (the scene or the picture is too large for this machine) choose a "
                   "smaller one\n",
                   stderr);
        return 2;
    } catch (std::exception const& e) {
        std::fputs(fmt::format("lightwell: internal error: {}\n", e.what()).c_str(), stderr);
        return 1;
    }
}

} // namespace viewer
