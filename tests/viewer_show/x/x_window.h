#pragma once
// A window of another program as its user has it: what the X server shows of it, and keys pressed on it.

#include <chrono>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

namespace viewer::test {

/// A connection of its own to the server that DISPLAY names. Of a window that has gone, pictures are empty and
/// the rest does nothing.
class XWindow {
public:
    /// Waits for a window on the screen whose title begins so. Throws std::runtime_error after the limit.
    explicit XWindow(std::string const& title, std::chrono::seconds limit = std::chrono::seconds(20));
    ~XWindow();
    XWindow(XWindow const&) = delete;
    XWindow& operator=(XWindow const&) = delete;

    glm::ivec2 size_px() const;
    glm::ivec2 position_px() const; ///< of its top left corner on the screen
    /// Pixels of the screen in the window's area: R, G, B, rows from the top.
    std::vector<unsigned char> picture() const;
    std::vector<unsigned char> picture(glm::ivec2 corner_px, glm::ivec2 size_px) const;

    void move(glm::ivec2 to_px);
    void resize(glm::ivec2 size_px);
    /// Asks the window to close as a window manager does (WM_DELETE_WINDOW).
    void ask_to_close();

    /// Keys go to it from now on.
    void focus();
    /// Presses a key by the XTEST extension, as a keyboard would.
    /// @param key  X's name: "w", "Escape", "F1"
    void press(std::string const& key);
    void release(std::string const& key);
    void tap(std::string const& key);
    /// The mouse, by the same way; from the window's top left corner.
    void point_at(glm::ivec2 px);
    void press_button(int number);
    void release_button(int number);
    /// Why no keys can be pressed; empty = they can.
    std::string const& key_problem() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace viewer::test
