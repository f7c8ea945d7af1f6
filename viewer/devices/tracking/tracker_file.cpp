#include "viewer/devices/tracking/tracker_file.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr std::size_t kLargestFile = std::size_t(1) << 30;
constexpr char const* kColumns[] = {"time_s", "body", "x_m", "y_m",     "z_m",    "qx",
                                    "qy",     "qz",   "qw",  "buttons", "visible"};
constexpr std::size_t kFewestColumns = 9;

/// Number of columns of the file.
std::size_t read_header(gi::TextLine const& line)
{
    auto const fields = gi::split_at_commas(line.text);
    for (std::size_t i = 0; i < fields.size(); ++i)
        if (i >= std::size(kColumns) || fields[i] != kColumns[i])
            throw line.error(fields[i], "column '" + std::string(fields[i]) + "' is not understood",
                             "the columns of tracker files are fixed",
                             "write time_s,body,x_m,y_m,z_m,qx,qy,qz,qw[,buttons[,visible]] in the first line");
    if (fields.size() < kFewestColumns)
        throw line.error(line.text, "columns are missing", "a pose needs nine",
                         "write time_s,body,x_m,y_m,z_m,qx,qy,qz,qw in the first line");
    return fields.size();
}

TrackerSample read_line(gi::TextLine const& line, std::size_t columns)
{
    auto const fields = gi::split_at_commas(line.text);
    if (fields.size() != columns)
        throw line.error(line.text, fmt::format("there are {} values", fields.size()),
                         fmt::format("the first line names {} columns", columns), "give one value per column");
    auto const number = [&](std::size_t i) {
        auto const n = gi::parse_finite(fields[i], kLargestNumber);
        if (!n)
            throw line.error(fields[i], "'" + std::string(fields[i]) + "' is not a number",
                             std::string(kColumns[i]) + " must be one, of at most 1e15", "correct it");
        return *n;
    };
    TrackerSample s;
    s.measured_s = number(0);
    s.body = fields[1];
    if (s.body.empty()) throw line.error(fields[1], "the body has no name", "it identifies the poses", "name it");
    s.pose.position = {number(2), number(3), number(4)};
    s.pose.rotation = {number(8), number(5), number(6), number(7)};
    if (columns > 9) {
        auto const buttons = gi::parse_number<std::uint64_t>(fields[9]);
        if (!buttons || *buttons > 0xffffffffu)
            throw line.error(fields[9], "'" + std::string(fields[9]) + "' is no set of buttons",
                             "bits 0 to 31 are, as a whole number", "write 0");
        s.buttons = std::uint32_t(*buttons);
    }
    if (columns > 10) {
        if (fields[10] != "0" && fields[10] != "1")
            throw line.error(fields[10], "visible is '" + std::string(fields[10]) + "'", "it is 0 or 1",
                             "write 1");
        s.visible = fields[10] == "1";
        s.quality = s.visible ? 1 : 0;
    }
    double const length = glm::length(s.pose.rotation);
    if (s.visible && !(std::abs(length - 1) < 0.05))
        throw line.error(fields[5], fmt::format("the quaternion's length is {}", length), "it must be 1",
                         "write qx,qy,qz,qw with qw last; 0,0,0,1 is no rotation");
    s.pose.rotation = s.visible ? glm::normalize(s.pose.rotation) : gi::dquat{1, 0, 0, 0};
    return s;
}

} // namespace

std::vector<TrackerSample> parse_tracker_file(std::string_view text, std::string const& file)
{
    std::vector<TrackerSample> samples;
    std::size_t columns = 0;
    for (int number = 1; !text.empty(); ++number) {
        gi::TextLine const line{gi::take_until(text, '\n'), file, number};
        std::string_view const content = gi::trimmed(line.text);
        if (content.empty() || content.front() == '#') continue;
        if (columns == 0) {
            columns = read_header(line);
            continue;
        }
        samples.push_back(read_line(line, columns));
        if (samples.size() > 1 && *samples.back().measured_s < *samples[samples.size() - 2].measured_s)
            throw line.error(line.text,
                             fmt::format("time {} is before the line above", *samples.back().measured_s),
                             "poses are played in their order", "sort the lines by time");
    }
    if (samples.empty())
        throw gi::InputError("'" + file + "' has no poses", "there is nothing to play",
                             "write one with lightwell track walk --out walk.csv");
    return samples;
}

std::string format_tracker_file(std::vector<TrackerSample> const& samples)
{
    std::string text;
    for (char const* const name : kColumns) text += std::string(text.empty() ? "" : ",") + name;
    text += "\n";
    for (TrackerSample const& s : samples) {
        gi::dvec3 const p = s.pose.position;
        gi::dquat const q = s.pose.rotation;
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", s.measured_s.value_or(s.received_s), s.body, p.x,
                            p.y, p.z, q.x, q.y, q.z, q.w, s.buttons.value_or(0), s.visible ? 1 : 0);
    }
    return text;
}

std::vector<TrackerSample> read_tracker_file(std::filesystem::path const& file)
{
    auto const bytes = gi::read_bytes(file, kLargestFile);
    return parse_tracker_file({reinterpret_cast<char const*>(bytes.data()), bytes.size()}, file.string());
}

FileTracker::FileTracker(std::vector<TrackerSample> samples, std::string name, AtEnd at_end, double speed)
    : samples_(std::move(samples)), name_(std::move(name)), at_end_(at_end), speed_(speed)
{
    if (!(speed > 0 && speed <= 1000))
        throw gi::InputError(fmt::format("speed {} of '{}'", speed, name_),
                             "more than 0 and up to 1000 is possible", "write 1");
    if (samples_.empty())
        throw gi::InputError("'" + name_ + "' has no poses", "there is nothing to play", "record some");
}

void FileTracker::poll(double now_s, std::vector<TrackerSample>& out)
{
    if (!start_s_) start_s_ = now_s;
    double const first = *samples_.front().measured_s, last = *samples_.back().measured_s;
    // When looping, a round lasts one step longer, because its last sample is not the first of the next round.
    double const step = samples_.size() > 1 ? (last - first) / double(samples_.size() - 1) : 1;
    double const round_s = std::max(1e-3, (last - first + step) / speed_);
    while (true) {
        if (next_ == samples_.size()) {
            if (at_end_ == AtEnd::stop) return;
            next_ = 0;
            *start_s_ += round_s;
            ++counts_.restarts;
        }
        TrackerSample s = samples_[next_];
        double const due = *start_s_ + (*s.measured_s - first) / speed_;
        if (due > now_s) return;
        s.received_s = due;
        s.measured_s = due; // on the playback clock
        out.push_back(std::move(s));
        ++counts_.samples;
        ++next_;
    }
}

} // namespace viewer
