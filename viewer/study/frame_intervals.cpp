#include "viewer/study/study_records.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <zlib.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;

/// Parses "step,attempt,shown,t_swap_s,...": key of the stimulus and swap time. Returns false for other lines.
bool parse(std::string const& line, std::string& stimulus, double& swap_s)
{
    std::size_t comma = 0;
    for (int field = 0; field < 3; ++field) {
        comma = line.find(',', comma);
        if (comma == std::string::npos) return false;
        ++comma;
    }
    char* end = nullptr;
    swap_s = std::strtod(line.c_str() + comma, &end);
    if (end == line.c_str() + comma || *end != ',') return false;
    stimulus = line.substr(0, comma);
    return true;
}

void add(fs::path const& file, std::vector<double>& intervals)
{
    std::unique_ptr<gzFile_s, int (*)(gzFile)> const in(gzopen(file.c_str(), "rb"), gzclose); // or plain
    if (!in) return;
    std::array<char, 1024> buffer{};
    std::string last;
    double last_s = 0;
    while (gzgets(in.get(), buffer.data(), int(buffer.size())) != nullptr) {
        std::string stimulus;
        double swap_s = 0;
        if (!parse(buffer.data(), stimulus, swap_s)) continue;
        if (stimulus == last) intervals.push_back(1e3 * (swap_s - last_s));
        last = std::move(stimulus);
        last_s = swap_s;
    }
}

} // namespace

std::vector<double> frame_intervals_ms(fs::path const& dir)
{
    std::vector<double> intervals;
    std::vector<fs::path> files;
    std::error_code failed;
    for (fs::recursive_directory_iterator it(dir, failed), end; !failed && it != end; it.increment(failed)) {
        std::string const name = it->path().filename().string();
        if (name.ends_with("_frames.csv") || name.ends_with("_frames.csv.gz")) files.push_back(it->path());
    }
    std::sort(files.begin(), files.end());
    for (fs::path const& file : files) add(file, intervals);
    return intervals;
}

} // namespace viewer
