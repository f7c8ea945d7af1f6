#include "ar/pose/pose_file.h"

#include "gi/core/error.h"
#include "gi/core/rotation.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace ar {
namespace {

constexpr std::array<std::string_view, 8> kColumns{"time_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"};
constexpr double kLargest = 1e15;
constexpr std::uintmax_t kLargestFile = std::uintmax_t(1) << 30;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

struct Line {
    std::string_view text;
    std::string const& file;
    int number;

    gi::InputError error(std::string_view at, std::string const& problem, std::string const& why,
                         std::string const& suggestion) const
    {
        return {gi::TextLocation{file, number, int(at.data() - text.data()) + 1}, problem, why, suggestion};
    }
};

std::vector<std::string_view> fields_of(std::string_view text, bool by_commas)
{
    std::vector<std::string_view> fields;
    while (true) {
        if (!by_commas) {
            text = trimmed(text);
            if (text.empty()) return fields;
        }
        std::size_t const n = by_commas ? text.find(',') : text.find_first_of(" \t\r");
        std::string_view const field = trimmed(text.substr(0, n));
        fields.push_back(field.empty() ? text.substr(0, 0) : field);
        if (n == std::string_view::npos) return fields;
        text.remove_prefix(n + 1);
    }
}

void read_header(Line const& line)
{
    auto const fields = fields_of(line.text, true);
    for (std::size_t i = 0; i < kColumns.size(); ++i)
        if (i >= fields.size() || fields[i] != kColumns[i])
            throw line.error(i < fields.size() ? fields[i] : line.text,
                             fmt::format("column {} is not '{}'", i + 1, kColumns[i]),
                             "the columns of files of poses are fixed",
                             fmt::format("begin with {}", fmt::join(kColumns, ",")));
    if (fields.size() > kColumns.size())
        throw line.error(fields[8], "there are more than 8 columns", "the columns of files of poses are fixed",
                         fmt::format("begin with {}", fmt::join(kColumns, ",")));
}

TimedPose read_pose(Line const& line, bool by_commas, CameraAxes axes)
{
    auto const fields = fields_of(line.text, by_commas);
    if (fields.size() != kColumns.size())
        throw line.error(line.text, fmt::format("there are {} values", fields.size()), "a pose has 8",
                         fmt::format("give {}", fmt::join(kColumns, " ")));
    std::array<double, 8> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
        auto const [end, error] = std::from_chars(fields[i].data(), fields[i].data() + fields[i].size(), v[i]);
        bool const whole = error == std::errc{} && end == fields[i].data() + fields[i].size();
        if (fields[i].empty() || !whole || !(std::abs(v[i]) <= kLargest))
            throw line.error(fields[i], fmt::format("'{}' is not a number", fields[i]),
                             fmt::format("{} is one, of at most 1e15", kColumns[i]), "correct it");
    }
    glm::dquat const q(v[7], v[4], v[5], v[6]);
    double const length = glm::length(q);
    if (!(std::abs(length - 1) < 0.05))
        throw line.error(fields[4], fmt::format("the quaternion's length is {}", length), "that of rotations is 1",
                         "write qx qy qz qw with qw last; 0 0 0 1 is no rotation");
    glm::dquat const vision_in_graphics(0, 1, 0, 0); // half a turn about x
    glm::dquat const turn = axes == CameraAxes::graphics ? q * vision_in_graphics : q;
    return {v[0], {glm::normalize(turn), {v[1], v[2], v[3]}}};
}

} // namespace

std::vector<TimedPose> parse_poses(std::string_view text, std::string const& file, CameraAxes axes)
{
    std::vector<TimedPose> poses;
    bool by_commas = false, begun = false;
    for (int number = 1; !text.empty(); ++number) {
        std::size_t const n = text.find('\n');
        Line const line{text.substr(0, n), file, number};
        text.remove_prefix(n == std::string_view::npos ? text.size() : n + 1);
        std::string_view const content = trimmed(line.text);
        if (content.empty() || content.front() == '#') continue;
        if (!begun) {
            begun = true;
            by_commas = content.find(',') != std::string_view::npos;
            if (by_commas) {
                read_header(line);
                continue;
            }
        }
        TimedPose const pose = read_pose(line, by_commas, axes);
        if (!poses.empty() && !(pose.time_s > poses.back().time_s))
            throw line.error(content, fmt::format("time {} is not after {}", pose.time_s, poses.back().time_s),
                             "poses between two times are made of both", "sort the lines by time, each time once");
        poses.push_back(pose);
    }
    if (poses.empty())
        throw gi::InputError(gi::TextLocation{file, 0, 0}, "there are no poses", "the camera is nowhere",
                             fmt::format("write lines of {}", fmt::join(kColumns, " ")));
    return poses;
}

std::vector<TimedPose> read_poses(std::filesystem::path const& file, CameraAxes axes)
{
    std::error_code error;
    std::uintmax_t const size = std::filesystem::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    if (error || !in)
        throw gi::InputError(fmt::format("'{}' cannot be read", file.string()), "it is missing or not a file",
                             "check the path");
    if (size > kLargestFile)
        throw gi::InputError(fmt::format("'{}' has {} bytes", file.string(), size), "at most 1 GiB is read",
                             "cut it into parts");
    std::ostringstream text;
    text << in.rdbuf();
    return parse_poses(text.str(), file.string(), axes);
}

std::string format_poses(std::vector<TimedPose> const& poses)
{
    std::string text = fmt::format("{}\n", fmt::join(kColumns, ","));
    for (TimedPose const& t : poses) {
        glm::dvec3 const p = t.world_from_camera.position_m;
        glm::dquat const q = t.world_from_camera.rotation;
        text += fmt::format("{},{},{},{},{},{},{},{}\n", t.time_s, p.x, p.y, p.z, q.x, q.y, q.z, q.w);
    }
    return text;
}

std::optional<Pose> pose_at(std::vector<TimedPose> const& poses, double time_s, double longest_gap_s)
{
    auto const after = std::lower_bound(poses.begin(), poses.end(), time_s,
                                        [](TimedPose const& p, double t) { return p.time_s < t; });
    if (after == poses.end()) return std::nullopt;
    if (after->time_s == time_s) return after->world_from_camera;
    if (after == poses.begin()) return std::nullopt;
    TimedPose const& a = *(after - 1);
    TimedPose const& b = *after;
    double const gap = b.time_s - a.time_s;
    if (!(gap <= longest_gap_s)) return std::nullopt;
    double const s = (time_s - a.time_s) / gap;
    glm::dvec3 const turn =
        gi::log_rotation(glm::conjugate(a.world_from_camera.rotation) * b.world_from_camera.rotation);
    return Pose{glm::normalize(a.world_from_camera.rotation * gi::exp_rotation(s * turn)),
                glm::mix(a.world_from_camera.position_m, b.world_from_camera.position_m, s)};
}

} // namespace ar
