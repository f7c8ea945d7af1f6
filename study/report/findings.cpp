#include "gi/core/html/html.h"
#include "study/analysis/shown.h"
#include "study/report/figures.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

std::string interval_text(Uncertain const& u) { return shown_estimate(u.value, u.interval.low, u.interval.high); }

/// Items, best first; "~" joins an item to the next one if they do not differ significantly.
std::string ranking_text(ScaleResult const& s)
{
    auto const order = by_score(s);
    std::string text;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k > 0) {
            ItemDifference const* const d = difference_of(s, order[k], order[k - 1]);
            bool const is_told = d != nullptr && d->p_holm < 0.05;
            text += is_told ? " &gt; " : " ~ ";
        }
        text += gi::escaped(s.items[std::size_t(order[k])].name);
    }
    return text;
}

/// Text with the adjusted levels.
std::string levels_text(ScaleResult const& s, bool is_log)
{
    std::string text;
    for (ScaledItem const& i : s.items) {
        Uncertain u = i.score;
        if (is_log) u = {std::exp(u.value), {std::exp(u.interval.low), std::exp(u.interval.high)}, u.n};
        text += (text.empty() ? "" : ", ") + gi::escaped(i.name) + " " + interval_text(u);
    }
    return "set to " + text;
}

std::string cheapest_text(ScaleResult const& s)
{
    Cheapest const& c = *s.cheapest;
    ScaledItem const &item = s.items[std::size_t(c.item)], &against = s.items[std::size_t(c.against)];
    std::string const stand_in =
        c.is_reference ? "the reference" : "the best judged item (the reference itself was not judged),";
    if (c.item == c.against)
        return fmt::format(
            "Nothing cheaper than <b>{}</b> ({} ms) is as good as {}: every cheaper one is significantly "
            "worse.",
            gi::escaped(item.name), shown_number(item.render_ms.value),
            c.is_reference ? "it, the reference" : "it, the best judged item (the reference was not judged)");
    std::string text = fmt::format(
        "The cheapest without significant difference from {} <b>{}</b> ({} ms) is <b>{}</b> ({} ms): "
        "difference {} {}, p {} "
        "corrected for all pairs.",
        stand_in, gi::escaped(against.name), shown_number(against.render_ms.value), gi::escaped(item.name),
        shown_number(item.render_ms.value), interval_text(c.difference), gi::escaped(s.unit),
        std::isfinite(c.p_holm) ? (c.p_holm < 0.001 ? "" : "= ") + gi::escaped(shown_p(c.p_holm)) : "unknown,");
    if (std::isfinite(c.difference.interval.low) && c.difference.interval.low < 0)
        text += fmt::format(" No significant difference does not mean equal: it may be up to {} {} worse.",
                            shown_number(-c.difference.interval.low), gi::escaped(s.unit));
    return text;
}

} // namespace

std::string findings(Analysis const& a)
{
    std::string html;
    for (BlockResult const& b : a.blocks) {
        if (!b.scales.empty() && b.scales.front().refused.empty()) {
            ScaleResult const& s = b.scales.front();
            html += fmt::format("<li><b>{}</b> ({} observers): {}. ", gi::escaped(b.name), s.observers,
                                b.task == "adjustment" ? levels_text(s, b.is_log) : ranking_text(s));
            html += (s.cheapest ? cheapest_text(s) : "") + "</li>\n";
        }
        for (CurveResult const& c : b.curves)
            if (c.refused.empty())
                html += fmt::format("<li><b>{}</b>, {}: {:.0f} % correct at {}.{}</li>\n", gi::escaped(b.name),
                                    gi::escaped(c.cell), 100 * c.proportion, interval_text(c.threshold),
                                    c.note.empty() ? "" : " Doubtful: " + gi::escaped(c.note) + ".");
    }
    if (html.empty()) return {};
    return gi::html_section(
        "In short",
        "<ul class=\"findings\">\n" + html + "</ul>\n" +
            gi::html_note("Best first; &gt; means significantly better than the next one (5 %, corrected "
                          "for all pairs by Holm's procedure), ~ that this was not shown."));
}

} // namespace study
