#include "viewer/cli/commands.h"
#include "viewer/cli/program.h"

int main(int argc, char** argv)
{
    static constexpr viewer::AddedCommand kOwn[]{
        {"ar", viewer::add_ar},
    };
    return viewer::run_program(argc, argv, kOwn);
}
