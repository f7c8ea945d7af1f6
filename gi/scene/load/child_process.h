#pragma once
#include <functional>
#include <optional>
#include <string>

namespace gi {

/// Runs `work` in a forked child process. `work` gets the writing end of a pipe and must end the process itself;
/// the child is killed if this process dies.
///
/// A child forked while other threads run may wait forever for a lock that one of them held (an allocator's, under
/// ASan). So a child that sleeps for five seconds without using CPU time is killed.
/// @param told  receives the data written to the pipe
/// @returns the status from waitpid; nothing if the child stalled, in which case another attempt may succeed
/// Throws InputError if no pipe or process can be created.
std::optional<int> run_child(std::function<void(int pipe)> const& work, std::string& told);

} // namespace gi
