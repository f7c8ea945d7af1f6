// Executes the program of the command with the same arguments. Calls without a known command are handled here.

#include "viewer/cli/command_table.h"
#include "viewer/cli/completion.h"
#include "viewer/cli/program.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

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

} // namespace

int main(int argc, char** argv)
{
    std::vector<char const*> words = as_option(argc, argv);
    // A word that is to be completed names no command yet.
    std::size_t const whole = words.size() - (std::getenv(viewer::kCompleteVariable) != nullptr ? 1 : 0);
    auto const program = viewer::program_of(whole > 1 ? words[1] : "", whole > 2 ? words[2] : "");
    if (program.empty() || program == "lightwell")
        return viewer::run_program(int(words.size()), words.data(), kOwn);
    std::error_code failed;
    auto const self = std::filesystem::read_symlink("/proc/self/exe", failed);
    std::string const file = self.parent_path() / program;
    words.push_back(nullptr);
    if (!failed) execv(file.c_str(), const_cast<char* const*>(words.data()));
    std::string const why = failed ? "/proc/self/exe: " + failed.message() : file + ": " + std::strerror(errno);
    std::fprintf(stderr,
                 "lightwell: '%s' cannot be started (%s) install its package (lightwell-view, lightwell-ar), or "
                 "build it: scripts/build release %s\n",
                 words[1], why.c_str(), std::string(program).c_str());
    return 2;
}
