#include "gi/core/html.h"
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
    return "<figure>\n" + inside + "\n<figcaption><strong>" + gi::escaped(title) + "</strong><br>" +
           gi::escaped(made_how(r) + "; " + cost_sentence(r)) + "</figcaption>\n</figure>\n";
}

std::string pair_html(BenchFolder const& folder, RenderStats const& left, RenderStats const& right)
{
    auto const eye = [&](RenderStats const& r) {
        return captioned(embedded_png(folder.path / r.png, r.eye + " eye"), r.eye + " eye", r);
    };
    std::string html = "<label><input type=\"checkbox\" class=\"swap\"> swap the pictures, for viewing with "
                       "crossed eyes</label>\n<div class=\"pair\">\n" +
                       eye(left) + eye(right) + "</div>\n";
    std::string words = fmt::format("The same moment from two eyes {:.3g} mm apart, with a common virtual screen",
                                    1000 * left.eye_distance_m);
    if (left.screen_distance_m > 0) words += fmt::format(" {:.3g} m away", left.screen_distance_m);
    html += "<p class=\"note\">" + gi::escaped(words) + ".</p>\n";
    if (left.anaglyph.empty()) return html;
    return html + "<details>\n<summary>the pair for red and cyan glasses</summary>\n" +
           embedded_png(folder.path / left.anaglyph, "anaglyph of both eyes") + "\n</details>\n";
}

std::string number_cell(double value, char const* form)
{
    return "<td class=\"number\">" + (std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : "") +
           "</td>";
}

std::string cost_row(RenderStats const& r)
{
    constexpr double kMiB = 1024.0 * 1024;
    return "<tr><td>" + gi::escaped(r.name) + "</td><td>" + gi::escaped(made_how(r)) + "</td>" +
           number_cell(r.structures_s, "{:.2f}") + number_cell(r.trace_s, "{:.2f}") +
           number_cell(r.denoise_s, "{:.2f}") + number_cell(r.whole_s, "{:.2f}") +
           number_cell(r.frame_s, "{:.2f}") + number_cell(r.frame_p95_s, "{:.2f}") +
           number_cell(r.relmse, "{:.2g}") + number_cell(r.memory_bytes / kMiB, "{:.0f}") + "</tr>\n";
}

std::string costs_html(std::vector<RenderStats const*> const& renders)
{
    std::string html = "<h3>Times and memory</h3>\n";
    if (std::string const& machine = renders.front()->machine; !machine.empty())
        html += "<p class=\"note\">" + gi::escaped(machine + "; " + renders.front()->program) + "</p>\n";
    html += "<div class=\"wide\"><table>\n<thead><tr><th scope=\"col\">file</th><th scope=\"col\">what</th>";
    for (char const* column : {"structures, s", "tracing, s", "filter, s", "whole, s", "median of frames, s",
                               "95 % of frames, s", "estimated relMSE, unfiltered", "most memory, MiB"})
        html += fmt::format("<th scope=\"col\" class=\"number\">{}</th>", column);
    html += "</tr></thead>\n<tbody>\n";
    for (RenderStats const* const r : renders) html += cost_row(*r);
    html += "</tbody></table></div>\n<details>\n<summary>to repeat them</summary>\n<pre><code>";
    for (RenderStats const* const r : renders) html += gi::escaped(r->command) + "\n";
    return html + "</code></pre>\n</details>\n";
}

} // namespace

std::string render_figures(BenchFolder const& folder)
{
    if (folder.renders.empty()) return "";
    std::string html = "<section>\n<h2>Pictures</h2>\n";
    std::vector<bool> shown(folder.renders.size(), false);
    for (auto const& [left, right] : stereo_pairs(folder.renders)) {
        html += pair_html(folder, folder.renders[left], folder.renders[right]);
        shown[left] = shown[right] = true;
    }
    html += "<div class=\"renders\">\n";
    std::vector<RenderStats const*> all;
    for (std::size_t i = 0; i < folder.renders.size(); ++i) {
        RenderStats const& r = folder.renders[i];
        all.push_back(&r);
        if (!r.video.empty())
            html += captioned(embedded_video(folder.path / r.video, r.name), r.name, r);
        else if (!r.png.empty() && r.frames == 0 && !shown[i])
            html += captioned(embedded_png(folder.path / r.png, r.name), r.name, r);
    }
    return html + "</div>\n" + costs_html(all) + "</section>\n";
}

} // namespace viewer
