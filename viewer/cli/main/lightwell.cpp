// Executes the program of the command with the same arguments, the one for this machine's processor. Calls without a known command are handled here.

#include "gi/core/error.h"
#include "gi/core/processor_level.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/completion.h"
#include "viewer/cli/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace {

namespace fs = std::filesystem;

void add_completion(CLI::App& parent, int&)
{
    auto const shell = std::make_shared<std::string>();
    CLI::App* const c = parent.add_subcommand("completion", viewer::about("completion"));
    c->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    c->footer(R"(To complete in every new shell:
  lightwell completion bash > ~/.local/share/bash-completion/completions/lightwell
  lightwell completion zsh > "${fpath[1]}/_lightwell"
  lightwell completion fish > ~/.config/fish/completions/lightwell.fish)");
    c->callback([shell] { std::fputs(viewer::completion_script(*shell).c_str(), stdout); });
}

constexpr viewer::AddedCommand kOwn[]{{"completion", add_completion}};

/// "help render" as "render --help".
std::vector<char const*> as_option(int argc, char** argv)
{
    std::vector<char const*> words(argv, argv + argc);
    if (argc > 1 && words[1] == std::string("help")) {
        words.erase(words.begin() + 1);
        bool const is_known = argc == 2 || !viewer::program_of(words[1], "").empty();
        if (is_known) words.push_back("--help"); // else the message about an unknown command
    }
    return words;
}

/// Which level's programs to use: that in LIGHTWELL_LEVEL, else the best one that is installed and runs on this machine.
/// @param here the folder of this program, whose programs are of its own level; folders in it are of others
/// @throws gi::InputError LIGHTWELL_LEVEL is no level, is not installed, or does not run here
std::string level_in(fs::path const& here)
{
    std::error_code none;
    char const* const forced = std::getenv("LIGHTWELL_LEVEL");
    if (forced == nullptr || *forced == '\0') {
        for (char const* const level : gi::kProcessorLevels)
            if (gi::has_level(level) && fs::is_directory(here / level, none)) return level;
        return gi::kCompiledLevel;
    }
    std::string const wanted = forced, problem = "LIGHTWELL_LEVEL=" + wanted;
    if (wanted == gi::kCompiledLevel) return wanted;
    if (std::ranges::find(gi::kProcessorLevels, wanted) == gi::kProcessorLevels.end())
        throw gi::InputError(problem, "there is no such level of processors",
                             fmt::format("choose {}", fmt::join(gi::kProcessorLevels, ", ")));
    if (!gi::has_level(forced))
        throw gi::InputError(problem, "this machine's processor is of a lower level", "choose that, or unset it");
    if (fs::is_directory(here / wanted, none)) return wanted;
    std::vector<std::string> there{gi::kCompiledLevel};
    for (char const* const level : gi::kProcessorLevels)
        if (gi::has_level(level) && fs::is_directory(here / level, none)) there.emplace_back(level);
    throw gi::InputError(problem, fmt::format("{} has no programs for it", here.string()),
                         fmt::format("choose {}, or unset it", fmt::join(there, " or ")));
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<char const*> words = as_option(argc, argv);
    // A word that is to be completed names no command yet.
    std::size_t const whole = words.size() - (std::getenv(viewer::kCompleteVariable) != nullptr ? 1 : 0);
    std::string_view const first = whole > 1 ? words[1] : "";
    bool const asks_version = first == "--version" || first == "-V";
    // What renders says for which level it was compiled.
    auto const program =
        asks_version ? viewer::program_of("render", "") : viewer::program_of(first, whole > 2 ? words[2] : "");
    if (program.empty() || program == "lightwell")
        return viewer::run_program(int(words.size()), words.data(), kOwn);
    std::error_code failed, none;
    auto const self = fs::read_symlink("/proc/self/exe", failed);
    fs::path file = self.parent_path() / program;
    try {
        std::string const level = level_in(self.parent_path());
        setenv("LIGHTWELL_LEVEL", level.c_str(), 1); // for what this program starts, as the tasks of a batch
        // What does not render is the same for all.
        if (fs::path const own = self.parent_path() / level / program; fs::exists(own, none)) file = own;
    } catch (gi::InputError const& e) {
        std::fprintf(stderr, "lightwell: %s\n", e.what());
        return 2;
    }
    words.push_back(nullptr);
    if (!failed) execv(file.c_str(), const_cast<char* const*>(words.data()));
    words.pop_back();
    if (asks_version) return viewer::run_program(int(words.size()), words.data(), kOwn);
    std::string const why =
        failed ? "/proc/self/exe: " + failed.message() : file.string() + ": " + std::strerror(errno);
    std::fprintf(stderr,
                 "lightwell: '%s' cannot be started (%s) install its package (lightwell-view, lightwell-ar), or "
                 "build it: scripts/build release %s\n",
                 words[1], why.c_str(), std::string(program).c_str());
    return 2;
}
