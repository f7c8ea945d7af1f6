#include "viewer/offline/ffmpeg.h"

#include "gi/core/error.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace viewer {
namespace {

std::string text_of(int file)
{
    std::string text;
    char chunk[4096];
    for (ssize_t n; (n = pread(file, chunk, sizeof chunk, off_t(text.size()))) > 0;)
        text.append(chunk, std::size_t(n));
    return text;
}

void close_once(int& file)
{
    if (file >= 0) close(std::exchange(file, -1));
}

} // namespace

Ffmpeg::Ffmpeg(std::vector<std::string> const& arguments)
{
    char const* const named = std::getenv("IMAGEIO_FFMPEG_EXE");
    std::string const program = named != nullptr && *named != '\0' ? named : "ffmpeg";
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (std::string const& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);

    // A socket, not a pipe: writing to a program that has ended is an error, not a signal.
    int ends[2] = {-1, -1};
    int error = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0 ? 0 : errno;
    input_ = ends[0];
    output_ = memfd_create("ffmpeg-output", MFD_CLOEXEC);
    messages_ = memfd_create("ffmpeg-messages", MFD_CLOEXEC);
    if (error == 0 && (output_ < 0 || messages_ < 0)) error = errno;
    if (error == 0) {
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, ends[1], STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&files, output_, STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&files, messages_, STDERR_FILENO);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes,
                                 POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        sigset_t none, pipe;
        sigemptyset(&none);
        sigemptyset(&pipe);
        sigaddset(&pipe, SIGPIPE);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &pipe);
        error = posix_spawnp(&process_, program.c_str(), &files, &attributes, argv.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
    }
    close_once(ends[1]);
    if (error == 0) return;
    process_ = -1;
    for (int* file : {&input_, &output_, &messages_}) close_once(*file);
    throw gi::InputError("videos cannot be written",
                         "the program '" + program +
                             "' cannot be started: " + std::generic_category().message(error),
                         "install the package ffmpeg, the wheel's extra \"video\", or save --png frames");
}

Ffmpeg::~Ffmpeg()
{
    if (process_ > 0) kill(process_, SIGKILL);
    finish();
    for (int* file : {&output_, &messages_}) close_once(*file);
}

bool Ffmpeg::write(std::span<unsigned char const> bytes)
{
    while (!bytes.empty()) {
        ssize_t const n = send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        bytes = bytes.subspan(std::size_t(n));
    }
    return true;
}

bool Ffmpeg::finish()
{
    close_once(input_);
    int status = -1;
    if (process_ > 0)
        while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
    process_ = -1;
    return status == 0;
}

std::string Ffmpeg::printed() const { return text_of(output_); }

std::string Ffmpeg::last_message() const
{
    std::string text = text_of(messages_);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.rfind('\n') + 1); // npos + 1 is 0
}

} // namespace viewer
