#pragma once
// Text for participants, drawn with Dear ImGui. Call between NewFrame and Render.

#include <functional>
#include <glm/vec2.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace viewer {

/// A line of Markdown to draw. Supports headings, paragraphs and lists; the marks of **bold**, *emphasis* and
/// `code` are removed; everything else is plain text.
struct PageLine {
    enum class Kind { text, heading, item, gap } kind = Kind::text;
    std::string text;
    bool operator==(PageLine const&) const = default;
};
std::vector<PageLine> parse_page(std::string_view markdown);

/// Fills the window with a page of text and a footer that lists the possible inputs.
/// @param more  draws below the text; may be empty
void draw_page(glm::vec2 size_px, std::vector<PageLine> const& lines, std::string const& footer,
               std::function<void()> const& more = {});
/// Draws a line at the bottom of the window, over pictures; nothing if it is empty.
void draw_prompt(glm::vec2 size_px, std::string const& text);
/// Draws a fixation cross at the window's centre.
void draw_cross(glm::vec2 size_px);
/// Draws one box per step of a scale and marks the chosen one. @param chosen  index; -1 = none
/// @return index of a clicked box, -1 = none
int draw_scale(float width_px, std::vector<std::string> const& steps, std::string const& low_label,
               std::string const& high_label, int chosen);

} // namespace viewer
