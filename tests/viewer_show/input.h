#pragma once
// A view with real keys and a mouse.

#include "tests/viewer_show/live_view.h"
#include "tests/viewer_show/x/x_window.h"

#include <glm/vec3.hpp>

namespace viewer::test {

class Input : public OnScreen {
protected:
    void open(std::string const& arguments, std::string const& title)
    {
        view.emplace(arguments);
        window.emplace(title);
        window->focus();
    }
    glm::dvec3 position()
    {
        Json const p = view->ask({{"do", "camera"}}).at("position");
        return {p[0], p[1], p[2]};
    }
    Json rotation() { return view->ask({{"do", "camera"}}).at("rotation"); }

    std::optional<LiveView> view;
    std::optional<XWindow> window;
};

#define NEED_KEYS()                                                                                               \
    if (!window->key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << window->key_problem()

} // namespace viewer::test
