#include "viewer/cli/program.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/progress.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/kept_memory.h"
#include "viewer/base/standard_streams.h"
#include "viewer/base/version.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/command_tree.h"
#include "viewer/cli/completion.h"
#include "viewer/cli/config_file.h"
#include "viewer/cli/examples.h"
#include "viewer/cli/man_page.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <new>
#include <stdexcept>
#include <unistd.h>
#include <utility>

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

std::vector<std::string> names_of(std::vector<CLI::App const*> const& commands)
{
    std::vector<std::string> names;
    for (CLI::App const* const c : commands) names.push_back(c->get_name());
    return names;
}

std::string suggest(std::string const& word, std::vector<std::string> const& known, std::string const& help)
{
    return gi::nearest_word(word, known) ? gi::suggest(word, known) + " " + help : help;
}

/// What other renderers call options. Names alone: their numbers may count other things.
constexpr std::pair<char const*, char const*> kNamesElsewhere[]{
    {"--spp", "--paths"},          {"--samples", "--paths"},       {"--depth", "--bounces"},
    {"--max-depth", "--bounces"},  {"--max-bounces", "--bounces"}, {"--integrator", "--method"},
    {"--resolution", "--size"},    {"--denoiser", "--denoise"},    {"--output", "--out"},
    {"--environment", "--envmap"},
};

/// Describes an invalid call. Unknown words are reported before missing arguments.
gi::InputError describe(CLI::ParseError const& e, CLI::App const& app)
{
    std::string const help = "see lightwell " + path_of_given(app) + "--help", misfit = "the call is not valid";
    bool const may_be_unknown = dynamic_cast<CLI::ExtrasError const*>(&e) != nullptr ||
                                dynamic_cast<CLI::RequiredError const*>(&e) != nullptr;
    for (CLI::App const* a = &app; may_be_unknown && a != nullptr;) {
        auto const given = a->get_subcommands();
        if (std::vector<std::string> const unknown = a->remaining(); !unknown.empty()) {
            std::string const word =
                unknown.front().substr(0, std::min<std::size_t>(64, unknown.front().find('=')));
            if (!word.starts_with('-') && given.empty() && a->get_require_subcommand_min() > 0)
                return {"there is no subcommand '" + word + "'", misfit,
                        suggest(word, names_of(subcommands(*a)), help)};
            for (CLI::Option const* const o : a->get_options())
                if (!word.starts_with('-') && o->count() > 0 && o->get_delimiter() != '\0' &&
                    !o->get_allow_extra_args())
                    return {"'" + word + "' was not expected", misfit,
                            fmt::format("if it belongs to {}: its values are joined by commas, without blanks",
                                        longest_name(*o))};
            std::vector<std::string> const names = option_names(*a);
            for (auto const& [other, own] : kNamesElsewhere)
                if (word == other && std::ranges::find(names, own) != names.end())
                    return {
                        "'" + word + "' was not expected", misfit,
                        fmt::format("did you mean '{}', which has this meaning or a similar one? {}", own, help)};
            return {"'" + word + "' was not expected", misfit, suggest(word, names, help)};
        }
        a = given.empty() ? nullptr : given.back();
    }
    return {e.what(), misfit, help};
}

/// One line, or, on a terminal, one for what is wrong, why, and what to do.
void print_error(gi::InputError const& e)
{
    std::string text = fmt::format("lightwell: {}\n", e.what());
    if (isatty(STDERR_FILENO) != 0) {
        std::string const all = e.what(), place = all.substr(0, all.find(e.problem()));
        text = fmt::format("lightwell: {}{}\n", place, e.problem());
        for (std::string const& part : {e.why(), e.suggestion()})
            if (!part.empty()) text += fmt::format("           {}\n", part);
    }
    std::fputs(text.c_str(), stderr);
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

/// Says of an option for a list whether its values are words of their own, or joined by commas.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_option_opts(CLI::Option const* o) const override
    {
        std::string text = CLI::Formatter::make_option_opts(o);
        std::size_t const dots = text.find(" ...");
        if (dots == text.npos || o->get_positional() || o->get_allow_extra_args()) return text;
        return text.replace(dots, 4, o->get_delimiter() != '\0' ? "[,...]" : " (repeatable)");
    }
};

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

/// One page for each command of this program; the launcher writes that of all.
int write_man_pages(CLI::App const& app, std::span<AddedCommand const> own, std::filesystem::path const& folder)
{
    auto const write = [&](CLI::App const& command, std::string name) {
        std::string const page = man_page(command, name, version_text());
        std::ranges::replace(name, ' ', '-');
        gi::write_text(folder / (name + ".1"), page);
    };
    bool overview = true;
    for (AddedCommand const& c : own) {
        std::size_t const space = c.name.find(' ');
        CLI::App const* command = find_subcommand(app, std::string(c.name.substr(0, space)));
        if (space != c.name.npos) command = find_subcommand(*command, std::string(c.name.substr(space + 1)));
        write(*command, "lightwell " + std::string(c.name));
        overview &= c.name == "completion";
    }
    if (overview) write(app, "lightwell");
    return 0;
}

/// Says so if results that were printed are lost.
bool output_failed()
{
    std::string const why = finish_standard_output();
    if (why.empty()) return false;
    std::fputs(
        ("lightwell: standard output cannot be written (" + why +
         ") files that the command names are complete; read the rest with a pipe or a file that stays open\n")
            .c_str(),
        stderr);
    return true;
}

} // namespace

int run_program(int argc, char const* const* argv, std::span<AddedCommand const> own)
{
    guard_standard_streams();
    keep_freed_memory();
    CLI::App app{"Lightwell: renders global illumination and measures its error."};
    app.set_version_flag("-V,--version", version_text());
    app.require_subcommand(1);
    app.formatter(std::make_shared<HelpFormatter>());
    app.get_formatter()->column_width(34);
    app.footer(R"(Examples:
  lightwell render atrium --size 160x100 --paths 16 --out atrium.exr --png atrium.png
  lightwell info atrium
  lightwell generate boxes --triangles 20000 --out boxes.glb

Exit codes: 0 done, 1 a comparison failed or not all outputs could be written, 2 the input or the call is wrong,
128 + the signal interrupted: 130 Ctrl-C, 143 SIGTERM, 129 a closed terminal. Ctrl-C in `view` exits cleanly with code 0.)");
    setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0); // silent: this program reports errors itself
    int exit_code = 0;
    add_commands(app, own, exit_code);
    keep_own_examples(app);
    try {
        std::vector<std::string> words(argv + 1, argv + argc);
        if (std::getenv(kCompleteVariable) != nullptr) {
            for (std::string const& c : complete(app, words)) fmt::print("{}\n", c);
            return 0;
        }
        if (char const* const folder = std::getenv(kManVariable)) return write_man_pages(app, own, folder);
        if (std::string const file = config_file(); !file.empty())
            if (auto const added = add_configured_options(app, file, words); !added.empty())
                std::fputs(fmt::format("lightwell: with {} of {}\n", fmt::join(added, " "), file).c_str(), stderr);
        std::ranges::reverse(words); // as CLI11 wants them
        app.parse(std::move(words));
        return output_failed() ? std::max(exit_code, 2) : exit_code;
    } catch (CLI::Success const& e) { // --help and --version
        return app.exit(e);
    } catch (CLI::ParseError const& e) {
        print_error(describe(e, app));
        return 2;
    } catch (gi::InputError const& e) {
        print_error(e);
        return 2;
    } catch (gi::Interrupted const&) {
        std::fputs("lightwell: interrupted before a picture was rendered\n", stderr);
        return interrupted_code();
    } catch (std::bad_alloc const&) {
        std::fputs("lightwell: out of memory (the scene or the picture is too large for this machine) choose a "
                   "smaller one\n",
                   stderr);
        return 2;
    } catch (std::exception const& e) {
        if (std::ferror(stdout) != 0 && output_failed()) // fmt::print throws then
            return was_interrupted() ? interrupted_code() : 2;
        std::fputs(fmt::format("lightwell: internal error: {}\n", e.what()).c_str(), stderr);
        return 1;
    }
}

} // namespace viewer
