#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "viewer/base/outputs.h"
#include "viewer/cli/commands.h"
#include "viewer/displays/compose.h"
#include "viewer/report/page.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

namespace fs = std::filesystem;

struct BenchReportOptions {
    std::vector<std::string> folders;
    std::string out;
    Page page;
};

/// As it was before the sRGB encoding was undone.
std::vector<unsigned char> png_bytes(gi::Picture const& picture)
{
    return gi::tone_map_bytes(*picture.find("color"), {});
}

/// Beside the left eye's picture; a pair that cannot be read is left to the page, which says so.
void make_anaglyphs(BenchFolder& folder)
{
    for (auto const& [l, r] : stereo_pairs(folder.renders)) {
        RenderStats& left = folder.renders[l];
        fs::path const file = folder.path / (fs::path(left.png).stem().string() + "_anaglyph.png");
        try {
            gi::Picture const one = gi::read_picture(folder.path / left.png),
                              other = gi::read_picture(folder.path / folder.renders[r].png);
            glm::ivec2 const size{one.width, one.height};
            gi::write_png(file, size.x, size.y,
                          compose_stereo(StereoMode::anaglyph_dubois, png_bytes(one), png_bytes(other), size));
        } catch (gi::InputError const& e) {
            std::fputs(fmt::format("note: no anaglyph of '{}': {}\n", left.png, e.what()).c_str(), stderr);
            continue;
        }
        left.anaglyph = file.filename().string();
    }
}

int run_bench_report(BenchReportOptions o)
{
    if (o.out.empty() && o.folders.size() > 1)
        throw gi::InputError("several folders without --out", "it is not known in which the page belongs",
                             "add --out page.html");
    check_ending(o.out, ".html", "a page", "end it with .html");
    for (std::string const& folder : o.folders) o.page.folders.push_back(read_bench_folder(folder));
    fs::path const file = o.out.empty() ? fs::path(o.folders.front()) / "report.html" : fs::path(o.out);
    check_outputs({file.string()}, {});
    for (BenchFolder& folder : o.page.folders) make_anaglyphs(folder);
    gi::write_text(file, make_page(o.page));
    fmt::print("{}\n", file.string());
    std::fflush(stdout);
    return 0;
}

} // namespace

void add_bench_report(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<BenchReportOptions>();
    CLI::App* const c = bench.add_subcommand(
        "report", "One page of all tables, and of all that render --stats tells, in folders.");
    c->add_option("DIR", o->folders,
                  "where bench commands have put their tables, and render --stats F.json its pictures and videos")
        ->required();
    c->add_option("--out", o->out, "the page, .html (default: DIR/report.html)");
    c->add_option("--title", o->page.title)->capture_default_str();
    c->add_option("--lead", o->page.lead, "a paragraph below the title");
    c->add_option("--next", o->page.next, "a command to show at the end; repeatable")
        ->take_all()
        ->allow_extra_args(false);
    c->footer(R"(Examples:
  lightwell bench sweep --scene cornell --budgets 20ms --repeats 1 --size 32x32 --reference-paths 16 --out sweep
  lightwell bench report sweep
  lightwell render cornell --eye left --paths 4 --size 64x48 --out sweep/left.exr --png sweep/left.png --stats sweep/left.json
  lightwell render cornell --eye right --paths 4 --size 64x48 --out sweep/right.exr --png sweep/right.png --stats sweep/right.json
  lightwell bench report sweep --out index.html --title Cornell

The page needs nothing beside itself: pictures (PNG) and videos (MP4) are in it. Two renders that differ in --eye alone are shown as a
stereo pair, and for red and cyan glasses as DIR/LEFT_anaglyph.png.)");
    c->callback([o, &exit_code] { exit_code = run_bench_report(*o); });
}

} // namespace viewer
