#include "ar/markers/draw.h"
#include "ar/markers/marker_map_file.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/outputs.h"
#include "viewer/base/validators.h"
#include "viewer/cli/ar/ar_arguments.h"
#include "viewer/cli/ar/ar_board_views.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

constexpr int kViews = 20;

struct BoardOptions {
    BoardArguments board;
    std::string out, markers, views;
    double dpi = 600, margin_m = -1;
    bool upright = false;
};

int run_board(BoardOptions const& o)
{
    check_outputs({o.out, o.markers}, {});
    ar::CharucoBoard board = board_of(o.board);
    if (!o.upright) board.world_from_board.rotation = glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0));
    ar::MarkerMap const map{{}, {board}, {}};
    ar::Sheet const sheet = ar::sheet_of(map, 0, o.margin_m);
    std::filesystem::path const out = o.out;
    if (out.extension() == ".svg") {
        gi::write_text(out, ar::to_svg(sheet));
    } else if (out.extension() == ".png") {
        double const dots_per_m = o.dpi / 0.0254;
        ar::write_png(out, ar::draw(sheet, dots_per_m), dots_per_m);
    } else {
        throw gi::InputError("--out '" + o.out + "' is of an unknown kind", "its ending decides the format",
                             "end it with .svg or .png");
    }
    if (!o.markers.empty()) ar::write_marker_map(o.markers, map);
    fmt::print(
        "{}: {:.1f} x {:.1f} mm, {} markers of {}; print it at 100 % and measure: {} squares are {:.1f} mm\n",
        o.out, 1e3 * sheet.width_m, 1e3 * sheet.height_m, ar::marker_count(board), board.dictionary,
        board.squares_x, 1e3 * board.square_m * board.squares_x);
    if (!o.markers.empty())
        fmt::print("{}: the board {}, its lower left corner in the origin\n", o.markers,
                   o.upright ? "stands upright, faces z" : "lies flat, its top towards -z");
    if (!o.views.empty()) {
        write_board_views(o.views, board, kViews);
        fmt::print("{}: {} views of it from the camera in truth.yaml\n", o.views, kViews);
    }
    return 0;
}

} // namespace

void add_ar_board(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<BoardOptions>();
    CLI::App* const c = ar.add_subcommand("board", "Draw a marker board for printing, and write its map.");
    declare_board_arguments(*c, o->board);
    c->get_option("--squares")->required();
    c->add_option("-o,--out", o->out, "drawing to write: .svg (in mm) or .png")->required();
    c->add_option("--markers", o->markers, "marker map to write (YAML), for ar run, track, calibrate and probe");
    c->add_option("--dpi", o->dpi, "dots per inch of a PNG")->check(in_range(20, 4800))->capture_default_str();
    c->add_option("--margin", o->margin_m, "white margin, m (default: one cell of a marker)")
        ->check(in_range(0, 10));
    c->add_flag("--upright", o->upright, "the board stands upright in the map (default: it lies flat)");
    c->add_option("--views", o->views, "folder for synthetic views from a known camera, to try ar calibrate");
    c->footer(R"(Examples:
  lightwell ar board --squares 7x5 --square 0.04 --marker 0.03 --out board.svg --markers markers.yaml
  lightwell ar board --squares 8x6 --square 0.02 --marker 0.014 --dictionary DICT_5X5_100 --out board.png

Printers may scale: measure the whole board with a ruler; if it is off, call again with the measured sides.)");
    c->callback([o, &exit_code] { exit_code = run_board(*o); });
}

} // namespace viewer
