// Executes the program of the command with the same arguments. Calls without a known command are handled here.

#include "viewer/cli/command_table.h"
#include "viewer/cli/program.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <unistd.h>

int main(int argc, char** argv)
{
    auto const program = viewer::program_of(argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : "");
    if (program.empty()) return viewer::run_program(argc, argv, {});
    std::error_code failed;
    auto const self = std::filesystem::read_symlink("/proc/self/exe", failed);
    std::string const file = self.parent_path() / program;
    if (!failed) execv(file.c_str(), argv);
    std::string const why = failed ? "/proc/self/exe: " + failed.message() : file + ": " + std::strerror(errno);
    std::fprintf(stderr, "lightwell: '%s' cannot be started (%s) build all programs: scripts/build release\n",
                 argv[1], why.c_str());
    return 2;
}
