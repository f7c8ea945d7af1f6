#include "viewer/cli/commands.h"
#include "viewer/cli/program.h"

int main(int argc, char** argv)
{
    static constexpr viewer::AddedCommand kOwn[]{
        {"view", viewer::add_view},   {"recording", viewer::add_recording},     {"remote", viewer::add_remote},
        {"track", viewer::add_track}, {"display", viewer::add_display},         {"avatar", viewer::add_avatar},
        {"xr", viewer::add_xr},       {"bench shown", viewer::add_bench_shown},
    };
    return viewer::run_program(argc, argv, kOwn);
}
