#pragma once
// Self-contained HTML pages: one style sheet for screen (light and dark) and print, no scripts, no other files.
// Arguments named "html" are HTML; all others are plain text and are escaped.

#include <concepts>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gi {

/// Escapes a text for HTML and SVG, as content or quoted attribute. Control characters become blanks.
std::string escaped(std::string_view text);
/// The same with its line ends, for elements that show them.
std::string escaped_lines(std::string_view text);

/// A whole page. @param header_html below the title
std::string html_page(std::string_view title, std::string_view main_html, std::string_view header_html = {});
std::string html_section(std::string_view title, std::string_view html);
/// A part of a section.
std::string html_part(std::string_view title, std::string_view html);
/// @param style  a class of the style sheet
std::string html_paragraph(std::string_view text, std::string_view style = {});
/// Elements that a class of the style sheet lays out.
std::string html_group(std::string_view style, std::string_view html);
/// A remark in smaller, fainter letters.
std::string html_note(std::string_view html);
/// A list of warnings; empty if there is none.
std::string html_cautions(std::vector<std::string> const& warnings);
/// Terms with their meanings.
std::string html_definitions(std::vector<std::pair<std::string, std::string>> const& entries);
/// Hidden until the reader opens it.
std::string html_details(std::string_view summary, std::string_view html);
/// Text as typed: commands.
std::string html_code(std::string_view text);
/// @param width_px of drawings; 0 = as wide as there is room
std::string html_figure(std::string_view html, std::string_view caption_html, double width_px = 0);

struct HtmlCell {
    HtmlCell() = default;
    template <class T>
    requires std::convertible_to<T, std::string_view> HtmlCell(T const& text) : html(escaped(text)) {}
    static HtmlCell of(std::string html, std::string css = {});

    std::string html;
    std::string css; ///< style of the cell
};
struct HtmlColumn {
    std::string name;
    bool is_number = false;  ///< aligned at the right
    std::string description; ///< shown as a hint
};
/// @param rows with one cell per column
std::string html_table(std::vector<HtmlColumn> const& columns, std::vector<std::vector<HtmlCell>> const& rows);

struct ShadedCell {
    std::string text;
    double share = 0; ///< strength of the cell's colour, -1 to 1; negative values have another colour
};
/// A matrix with the same names at its rows and columns, or without names. @param cells row by row
std::string html_matrix(std::string_view caption, std::vector<std::string> const& names,
                        std::vector<std::vector<ShadedCell>> const& cells);

std::string_view html_style();

} // namespace gi
