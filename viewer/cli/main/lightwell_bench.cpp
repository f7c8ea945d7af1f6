#include "viewer/cli/commands.h"
#include "viewer/cli/program.h"

int main(int argc, char** argv)
{
    static constexpr viewer::AddedCommand kOwn[]{
        {"bench", viewer::add_bench},
    };
    return viewer::run_program(argc, argv, kOwn);
}
