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

/// The sRGB bytes of the PNG file that the picture was read from.
std::vector<unsigned char> png_bytes(gi::Picture const& picture)
{
    return gi::tone_map_bytes(*picture.find("color"), {});
}

/// Writes an anaglyph beside each left picture. Pairs that cannot be read are skipped; the page reports them.
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
        throw gi::InputError("several folders without --out", "the folder for the page is not known",
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
    CLI::App* const c =
        bench.add_subcommand("report", "Make one HTML page of all tables and render --stats files in folders.");
    c->add_option("DIR", o->folders,
                  "folder with tables of bench commands, and F.json, pictures and videos of render --stats F.json")
        ->required();
    c->add_option("-o,--out", o->out, "page to write, .html (default: DIR/report.html)");
    c->add_option("--title", o->page.title)->capture_default_str();
    c->add_option("--lead", o->page.lead, "text of a paragraph below the title");
    c->add_option("--next", o->page.next, "command to show at the end; repeatable")
        ->take_all()
        ->allow_extra_args(false);
    c->footer(R"(Prepared by:
  lightwell bench sweep --scene cornell --budgets 20ms --repeats 1 --size 32x32 --reference-paths 16 --out sweep
  lightwell render cornell --eye left --paths 4 --size 64x48 --out sweep/left.exr --png sweep/left.png --stats sweep/left.json
  lightwell render cornell --eye right --paths 4 --size 64x48 --out sweep/right.exr --png sweep/right.png --stats sweep/right.json
Examples:
  lightwell bench report sweep
  lightwell bench report sweep --out index.html --title Cornell

The page is self-contained: pictures (PNG) and videos (MP4) are embedded. Two renders that differ only in --eye are
shown as a stereo pair, and as an anaglyph for red and cyan glasses, which is saved as DIR/LEFT_anaglyph.png.)");
    c->callback([o, &exit_code] { exit_code = run_bench_report(*o); });
}

} // namespace viewer
