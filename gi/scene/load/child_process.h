#pragma once
#include <functional>
#include <optional>
#include <string>

namespace gi {

/// Runs `work` in a copy of this process, which dies with it, which gets the writing end of a pipe and has to end
/// by itself.
///
/// A copy made while other threads run may wait for ever for a lock that one of them held (an allocator's, under
/// ASan). So one that sleeps for five seconds without using the processor is killed.
/// @param told  gets what was written to the pipe
/// @returns its status as of waitpid; nothing where it stalled, after which another try may succeed
/// Throws InputError where there is no pipe or process to be had.
std::optional<int> run_child(std::function<void(int pipe)> const& work, std::string& told);

} // namespace gi
