#include "viewer/protocol/recording/frame_log.h"

#include <sstream>

namespace viewer {

FrameLog::FrameLog(std::filesystem::path const& file, std::string const& about, gi::Report& report)
    : file_(file, "lines of the frame log", report)
{
    std::string top;
    std::istringstream lines(about);
    for (std::string line; std::getline(lines, line);) top += "# " + line + "\n";
    file_.append(top + frame_times_header());
}

void FrameLog::append(FrameTimes const& times) { file_.append(csv_line(times)); }

} // namespace viewer
