// Becomes the program that has the command, with the same arguments; what names no command is answered here.

#include "viewer/command_table.h"
#include "viewer/program.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <unistd.h>

int main(int argc, char** argv)
{
    auto const program = viewer::program_of(argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : "");
    if (program.empty()) return viewer::run_program(argc, argv, {});
    std::error_code failed;
    auto const here = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
    std::string const file = here / program;
    execv(file.c_str(), argv);
    std::fprintf(stderr, "lightwell: '%s' is not here (the program '%s', which has it, cannot be started) "
                         "build all: scripts/build release\n", argv[1], file.c_str());
    return 2;
}
