#include "gi/core/html/html.h"

#include <cmath>
#include <fmt/format.h>

namespace gi {

std::string escaped(std::string_view text)
{
    std::string out;
    for (char const c : text) switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        case '\'':
            out += "&#39;";
            break;
        default:
            out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    return out;
}

std::string html_page(std::string_view title, std::string_view main_html, std::string_view header_html)
{
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                       "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{0}</title>\n<style>\n{1}"
                       "</style>\n</head>\n<body>\n<header><h1>{0}</h1>\n{2}</header>\n<main>\n{3}</main>\n"
                       "</body>\n</html>\n",
                       escaped(title), html_style(), header_html, main_html);
}

std::string html_section(std::string_view title, std::string_view html)
{
    return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", escaped(title), html);
}

std::string html_part(std::string_view title, std::string_view html)
{
    return fmt::format("<h3>{}</h3>\n{}", escaped(title), html);
}

std::string html_paragraph(std::string_view text, std::string_view style)
{
    return fmt::format("<p{}>{}</p>\n", style.empty() ? "" : fmt::format(" class=\"{}\"", style), escaped(text));
}

std::string html_group(std::string_view style, std::string_view html)
{
    return fmt::format("<div class=\"{}\">\n{}</div>\n", style, html);
}

std::string html_note(std::string_view html) { return fmt::format("<p class=\"note\">{}</p>\n", html); }

std::string html_cautions(std::vector<std::string> const& warnings)
{
    std::string html;
    for (std::string const& w : warnings) html += "<li>" + escaped(w) + "</li>";
    return html.empty() ? "" : "<ul class=\"cautions\">" + html + "</ul>\n";
}

std::string html_definitions(std::vector<std::pair<std::string, std::string>> const& entries)
{
    std::string html = "<dl>\n";
    for (auto const& [term, meaning] : entries)
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(term), escaped(meaning));
    return html + "</dl>\n";
}

std::string html_details(std::string_view summary, std::string_view html)
{
    return fmt::format("<details>\n<summary>{}</summary>\n{}</details>\n", escaped(summary), html);
}

std::string escaped_lines(std::string_view text)
{
    std::string lines; // escaped() would make blanks of line ends
    for (char const c : text) lines += c == '\n' ? "\n" : escaped({&c, 1});
    return lines;
}

std::string html_code(std::string_view text) { return "<pre><code>" + escaped_lines(text) + "</code></pre>\n"; }

std::string html_figure(std::string_view html, std::string_view caption_html, double width_px)
{
    return fmt::format("<figure{}>\n{}{}</figure>\n",
                       width_px > 0 ? fmt::format(" style=\"width: {:.0f}px\"", width_px) : "", html,
                       caption_html.empty() ? "" : fmt::format("<figcaption>{}</figcaption>\n", caption_html));
}

HtmlCell HtmlCell::of(std::string html, std::string css)
{
    HtmlCell cell;
    cell.html = std::move(html);
    cell.css = std::move(css);
    return cell;
}

std::string html_table(std::vector<HtmlColumn> const& columns, std::vector<std::vector<HtmlCell>> const& rows)
{
    auto const number = [](HtmlColumn const& c) { return c.is_number ? " class=\"number\"" : ""; };
    std::string html = "<div class=\"scroll\"><table>\n<thead><tr>";
    for (HtmlColumn const& c : columns)
        html +=
            fmt::format("<th scope=\"col\"{}{}>{}</th>", number(c),
                        c.description.empty() ? "" : " title=\"" + escaped(c.description) + "\"", escaped(c.name));
    html += "</tr></thead>\n<tbody>\n";
    for (auto const& row : rows) {
        html += "<tr>";
        for (std::size_t c = 0; c < row.size(); ++c)
            html += fmt::format("<td{}{}>{}</td>", c < columns.size() ? number(columns[c]) : "",
                                row[c].css.empty() ? "" : " style=\"" + row[c].css + "\"", row[c].html);
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string html_matrix(std::string_view caption, std::vector<std::string> const& names,
                        std::vector<std::vector<ShadedCell>> const& cells)
{
    std::string html = fmt::format("<table class=\"matrix\"><caption>{}</caption>", escaped(caption));
    if (!names.empty()) {
        html += "<thead><tr><th></th>";
        for (std::string const& name : names) html += "<th scope=\"col\">" + escaped(name) + "</th>";
        html += "</tr></thead>";
    }
    html += "<tbody>";
    for (std::size_t r = 0; r < cells.size(); ++r) {
        html += "<tr>";
        if (!names.empty()) html += "<th scope=\"row\">" + escaped(names[r]) + "</th>";
        for (ShadedCell const& cell : cells[r])
            html += fmt::format("<td style=\"--share:{:.0f}%\"{}>{}</td>", 100 * std::abs(cell.share),
                                cell.share < 0 ? " class=\"lost\"" : "", escaped(cell.text));
        html += "</tr>";
    }
    return html + "</tbody></table>\n";
}

} // namespace gi
