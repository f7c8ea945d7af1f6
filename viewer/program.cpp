#include "viewer/program.h"

#include "ar/base/error.h"
#include "gi/base/error.h"
#include "study/base/script_error.h"
#include "viewer/commands.h"
#include "viewer/version.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <new>
#include <stdexcept>

namespace viewer {
namespace {

/// Of the innermost subcommand that was given, e.g. "track listen ".
std::string path_of_given(CLI::App const& app)
{
    std::string path;
    for (auto given = app.get_subcommands(); !given.empty(); given = given.back()->get_subcommands())
        path += given.back()->get_name() + " ";
    return path;
}

} // namespace

int run_program(int argc, char const* const* argv)
{
    CLI::App app{"Lightwell: globally lit pictures with their error beside them."};
    app.set_version_flag("--version", version_text());
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    app.footer(R"(Examples:
  lightwell render atrium --size 160x100 --paths 16 --out atrium.exr --png atrium.png
  lightwell info atrium
  lightwell generate boxes --triangles 20000 --out boxes.glb

Exit codes: 0 done, 1 a comparison failed or not all could be written, 2 the input or the call is wrong, 130 interrupted.
Who ends view by Ctrl-C leaves it in order: 0.)");
    int exit_code = 0;
    add_render(app, exit_code);
    add_view(app, exit_code);
    add_compare(app, exit_code);
    add_info(app, exit_code);
    add_generate(app, exit_code);
    add_recording(app, exit_code);
    add_remote(app, exit_code);
    add_track(app, exit_code);
    add_display(app, exit_code);
    add_xr(app, exit_code);
    add_study(app, exit_code);
    add_ar(app, exit_code);
    add_bench(app, exit_code);
    try {
        app.parse(argc, argv);
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            throw std::runtime_error("standard output could not be written");
        return exit_code;
    } catch (CLI::Success const& e) { // --help and --version
        return app.exit(e);
    } catch (CLI::ParseError const& e) {
        std::fputs(fmt::format("lightwell: {} (the call does not fit) see lightwell {}--help\n", e.what(),
                               path_of_given(app))
                       .c_str(),
                   stderr);
        return 2;
    } catch (gi::InputError const& e) {
        std::fputs(fmt::format("lightwell: {}\n", e.what()).c_str(), stderr);
        return 2;
    } catch (study::ScriptError const& e) {
        std::fputs(fmt::format("lightwell: {}\n", e.what()).c_str(), stderr);
        return 2;
    } catch (ar::InputError const& e) {
        std::fputs(fmt::format("lightwell: {}\n", e.what()).c_str(), stderr);
        return 2;
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
