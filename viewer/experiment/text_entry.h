#pragma once
// Text that a participant types, with a cursor.

#include "viewer/devices/gl/input_event.h"

#include <string>

namespace viewer {

class TextEntry {
public:
    /// @param lines      height of the box; enter begins a line if there are several
    /// @param max_chars  Unicode characters; more are not taken
    /// @param text       to begin with, UTF-8; the cursor is at its end
    TextEntry(int lines, int max_chars, std::string text = "");

    /// Characters, arrows, home, end, backspace and delete; enter, without control, in a text of several lines.
    void take(InputEvent const& event);
    std::string const& text() const { return text_; } ///< UTF-8
    std::size_t cursor() const { return cursor_; }    ///< byte before which characters are inserted
    bool is_full() const;

    /// Draws the box with the text, by ImGui: as high as its lines, higher if the text needs it.
    void draw(float width_px) const;

private:
    void insert(unsigned unicode);
    std::size_t before(std::size_t at) const; ///< start of the character that ends there
    std::size_t after(std::size_t at) const;  ///< end of the character that begins there
    std::size_t line_start(std::size_t at) const;
    std::size_t line_end(std::size_t at) const;
    void move_line(int by);

    int lines_, max_chars_;
    std::string text_;
    std::size_t cursor_;
};

} // namespace viewer
