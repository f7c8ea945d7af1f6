#include "viewer/cli/commands.h"
#include "viewer/cli/program.h"

int main(int argc, char** argv)
{
    static constexpr viewer::AddedCommand kOwn[]{
        {"render", viewer::add_render}, {"compare", viewer::add_compare},   {"denoise", viewer::add_denoise},
        {"info", viewer::add_info},     {"generate", viewer::add_generate},
    };
    return viewer::run_program(argc, argv, kOwn);
}
