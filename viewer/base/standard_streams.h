#pragma once
// Notes on standard error; guards against closed or broken standard streams.

#include <string>

namespace viewer {

/// Makes it safe to open files and to print: where standard input, output or error are closed, the next file that
/// is opened would get what is printed, so a device that cannot be written takes their place; and when the reader
/// of a pipe goes away, the write fails instead of ending the program (SIGPIPE).
void guard_standard_streams();

/// Writes out what is buffered. @returns why standard output could not be written, now or earlier; empty = it was
std::string finish_standard_output();

/// Prints "note: TEXT" on stderr.
void say(std::string const& text);
/// Turns off all notes of this process; called once by ranks of a cluster that do not lead.
void be_silent();

} // namespace viewer
