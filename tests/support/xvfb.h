#pragma once
// An X server without a screen for a test of its own, on a display number that it finds itself.

#include <string>
#include <sys/types.h>

namespace gi::test {

class Xvfb {
public:
    /// Starts Xvfb and sets DISPLAY for this process; problem() is not empty where it could not be.
    Xvfb(int width, int height);
    /// Ends the server and restores DISPLAY.
    ~Xvfb();
    Xvfb(Xvfb const&) = delete;
    Xvfb& operator=(Xvfb const&) = delete;

    std::string const& problem() const { return problem_; }
    std::string const& display() const { return display_; } ///< ":1"

private:
    pid_t server_ = -1;
    std::string display_, problem_, before_;
    bool had_display_ = false;
};

/// Runs a shell command; its exit code.
int run_shell(std::string const& command);

} // namespace gi::test
