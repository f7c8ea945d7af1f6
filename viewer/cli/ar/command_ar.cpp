#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>

namespace viewer {

void add_ar(CLI::App& app, int& exit_code)
{
    CLI::App* const ar = app.add_subcommand("ar", about("ar"));
    ar->require_subcommand(1);
    ar->footer(R"(Examples:
  lightwell ar synthesize desk --frames 2 --size 160x120 --paths 4
  lightwell ar run desk/session.yaml --fast --poses desk/poses.csv --truth desk/truth --out desk/out)");

    add_ar_synthesize(*ar, exit_code);
    add_ar_run(*ar, exit_code);
    add_ar_track(*ar, exit_code);
    add_ar_bench(*ar, exit_code);
    add_ar_cameras(*ar, exit_code);
    add_ar_record(*ar, exit_code);
    add_ar_replay(*ar, exit_code);
    add_ar_board(*ar, exit_code);
    add_ar_calibrate(*ar, exit_code);
    add_ar_lens(*ar, exit_code);
    add_ar_response(*ar, exit_code);
    add_ar_vignetting(*ar, exit_code);
    add_ar_noise(*ar, exit_code);
    add_ar_colour(*ar, exit_code);
    add_ar_probe(*ar, exit_code);
    add_ar_map(*ar, exit_code);
    add_ar_albedo(*ar, exit_code);
    add_ar_light(*ar, exit_code);
}

} // namespace viewer
