#pragma once
// The program `ffmpeg`, which writes videos: in a process of its own, so that only videos load its libraries.

#include <span>
#include <string>
#include <sys/types.h>
#include <vector>

namespace viewer {

/// A run of `ffmpeg` (IMAGEIO_FFMPEG_EXE in the environment names another one, as for Python's imageio). It ignores Ctrl-C, and is killed if
/// this object ends before it.
class Ffmpeg {
public:
    /// @param arguments  without the program's name
    /// Throws InputError if there is no such program.
    explicit Ffmpeg(std::vector<std::string> const& arguments);
    ~Ffmpeg();
    Ffmpeg(Ffmpeg const&) = delete;
    Ffmpeg& operator=(Ffmpeg const&) = delete;

    /// To its standard input. @returns false once it reads no more
    bool write(std::span<unsigned char const> bytes);
    /// Closes its standard input and waits for its end. @returns whether it had no errors
    bool finish();
    std::string printed() const;
    /// The last line of its messages.
    std::string last_message() const;

private:
    pid_t process_ = -1;
    int input_ = -1, output_ = -1, messages_ = -1;
};

} // namespace viewer
