#include "gi/core/html/html.h"
#include "viewer/report/html.h"
#include "viewer/report/page.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

std::string plural(double count, std::string const& word)
{
    return fmt::format("{:g} {}{}", count, word, count == 1 ? "" : "s");
}

std::string made_how(RenderStats const& r)
{
    std::string words = fmt::format("{}, {} × {} pixels", r.method, r.width, r.height);
    if (std::isfinite(r.paths))
        words += ", " + plural(r.paths, "path") + (r.frames > 0 ? " per pixel and frame" : " per pixel");
    return words + (r.denoise == "none" ? ", no filter" : ", filter " + r.denoise);
}

std::string cost_sentence(RenderStats const& r)
{
    std::string words = fmt::format("{:.3g} s including all structures", r.whole_s);
    if (r.frames > 0 && std::isfinite(r.frame_s))
        words = fmt::format("{} in {:.3g} s; median {:.3g} s per frame", plural(r.frames, "frame"), r.whole_s,
                            r.frame_s);
    return words;
}

std::string captioned(std::string const& inside, std::string const& title, RenderStats const& r)
{
    return gi::html_figure(inside, "<b>" + gi::escaped(title) + "</b><br>" +
                                       gi::escaped(made_how(r) + "; " + cost_sentence(r)));
}

std::string pair_html(BenchFolder const& folder, RenderStats const& left, RenderStats const& right)
{
    auto const eye = [&](RenderStats const& r) {
        return captioned(embedded_png(folder.path / r.png, r.eye + " eye"), r.eye + " eye", r);
    };
    std::string html = "<label><input type=\"checkbox\" class=\"swap\"> swap the pictures, for viewing with "
                       "crossed eyes</label>\n" +
                       gi::html_group("pair", eye(left) + eye(right));
    std::string words = fmt::format("The same moment from two eyes {:.3g} mm apart, with a common virtual screen",
                                    1000 * left.eye_distance_m);
    if (left.screen_distance_m > 0) words += fmt::format(" {:.3g} m away", left.screen_distance_m);
    html += gi::html_note(gi::escaped(words) + ".");
    if (left.anaglyph.empty()) return html;
    return html + gi::html_details("the pair for red and cyan glasses",
                                   embedded_png(folder.path / left.anaglyph, "anaglyph of both eyes"));
}

std::vector<gi::HtmlCell> cost_row(RenderStats const& r)
{
    constexpr double kMiB = 1024.0 * 1024;
    auto const known = [](double value, int digits) {
        return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "";
    };
    return {r.name,
            made_how(r),
            known(r.structures_s, 2),
            known(r.trace_s, 2),
            known(r.denoise_s, 2),
            known(r.whole_s, 2),
            known(r.frame_s, 2),
            known(r.frame_p95_s, 2),
            std::isfinite(r.relmse) ? fmt::format("{:.2g}", r.relmse) : "",
            known(r.memory_bytes / kMiB, 0)};
}

std::string costs_html(std::vector<RenderStats const*> const& renders)
{
    std::string html, commands;
    if (std::string const& machine = renders.front()->machine; !machine.empty())
        html = gi::html_note(gi::escaped(machine + "; " + renders.front()->program));
    std::vector<gi::HtmlColumn> columns{{"file", false, ""}, {"what", false, ""}};
    for (char const* column : {"structures, s", "tracing, s", "filter, s", "whole, s", "median of frames, s",
                               "95 % of frames, s", "estimated relMSE, unfiltered", "most memory, MiB"})
        columns.push_back({column, true, ""});
    std::vector<std::vector<gi::HtmlCell>> rows;
    for (RenderStats const* const r : renders) {
        rows.push_back(cost_row(*r));
        commands += r->command + "\n";
    }
    return gi::html_part("Times and memory", html + gi::html_table(columns, rows) +
                                                 gi::html_details("to repeat them", gi::html_code(commands)));
}

} // namespace

std::string render_figures(BenchFolder const& folder)
{
    if (folder.renders.empty()) return "";
    std::string html, pictures;
    std::vector<bool> shown(folder.renders.size(), false);
    for (auto const& [left, right] : stereo_pairs(folder.renders)) {
        html += pair_html(folder, folder.renders[left], folder.renders[right]);
        shown[left] = shown[right] = true;
    }
    std::vector<RenderStats const*> all;
    for (std::size_t i = 0; i < folder.renders.size(); ++i) {
        RenderStats const& r = folder.renders[i];
        all.push_back(&r);
        if (!r.video.empty())
            pictures += captioned(embedded_video(folder.path / r.video, r.name), r.name, r);
        else if (!r.png.empty() && r.frames == 0 && !shown[i])
            pictures += captioned(embedded_png(folder.path / r.png, r.name), r.name, r);
    }
    return gi::html_section("Pictures", html + gi::html_group("renders", pictures) + costs_html(all));
}

} // namespace viewer
