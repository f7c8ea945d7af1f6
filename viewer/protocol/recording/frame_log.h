#pragma once
// --frame-log: one line of CSV per frame, written in the background and readable at any time.

#include "viewer/protocol/recording/append_file.h"
#include "viewer/protocol/recording/frame_times.h"

namespace viewer {

class FrameLog {
public:
    /// @param about lines for the top of the file, e.g. the program and its command line; may be empty
    /// Throws InputError if the file exists or cannot be created.
    FrameLog(std::filesystem::path const& file, std::string const& about, gi::Report& report);

    /// Does not wait for the disk.
    void append(FrameTimes const& times);
    std::string failure() const { return file_.failure(); }
    void close() { file_.close(); }

private:
    AppendFile file_;
};

} // namespace viewer
