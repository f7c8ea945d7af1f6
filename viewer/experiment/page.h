#pragma once
// Text for participants, drawn with Dear ImGui: to be called between its NewFrame and Render.

#include <functional>
#include <glm/vec2.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace viewer {

/// A line of Markdown as it is drawn. Known are headings, paragraphs, lists, **bold**, *emphasis* and `code`
/// (whose marks are taken off); everything else is text.
struct PageLine {
    enum class Kind { text, heading, item, gap } kind = Kind::text;
    std::string text;
    bool operator==(PageLine const&) const = default;
};
std::vector<PageLine> parse_page(std::string_view markdown);

/// All of the window: a page of text, and below it what the participant can do.
/// @param more  drawn under the text; may be empty
void draw_page(glm::vec2 size_px, std::vector<PageLine> const& lines, std::string const& footer,
               std::function<void()> const& more = {});
/// A line at the bottom of the window, over pictures; nothing where it is empty.
void draw_prompt(glm::vec2 size_px, std::string const& text);
/// In the middle of the window.
void draw_cross(glm::vec2 size_px);
/// Boxes for the steps of a scale, the chosen one marked. @param chosen  index; -1 = none
/// @return one that was clicked, -1 = none
int draw_scale(float width_px, std::vector<std::string> const& steps, std::string const& low_label,
               std::string const& high_label, int chosen);

} // namespace viewer
