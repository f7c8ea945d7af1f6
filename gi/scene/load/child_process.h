#pragma once
#include <functional>
#include <optional>
#include <string>
#include <sys/types.h>

namespace gi {

/// A forked child process that writes to a pipe. It is killed if this object or this process ends before it.
///
/// A child forked while other threads run may wait forever for a lock that one of them held (an allocator's, under
/// ASan). So a child that sleeps for five seconds without using CPU time, while it is read, is killed: it stalled.
class ChildProcess {
public:
    /// @param work  gets the writing end of the pipe and must end the process itself
    /// Throws InputError if no pipe or process can be created.
    explicit ChildProcess(std::function<void(int pipe)> const& work);
    ~ChildProcess();
    ChildProcess(ChildProcess const&) = delete;
    ChildProcess& operator=(ChildProcess const&) = delete;

    /// Waits until the child writes more and appends it. @returns false if it has ended or stalled
    /// Throws what a listener of steps throws.
    bool read(std::string& told);
    /// Call after read() returned false. @returns the status from waitpid; nothing if the child stalled, in which
    /// case another attempt may succeed
    std::optional<int> status();

private:
    pid_t child_ = -1;
    int pipe_ = -1;
    bool stalled_ = false;
};

} // namespace gi
