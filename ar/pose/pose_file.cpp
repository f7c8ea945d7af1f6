#include "ar/pose/pose_file.h"

#include "ar/pose/pose_import.h"
#include "gi/core/rotation.h"
#include "gi/core/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace ar {
namespace {

constexpr std::array<std::string_view, 8> kColumns{"time_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"};
constexpr double kLargest = 1e15;
constexpr std::uintmax_t kLargestFile = std::uintmax_t(1) << 30;

std::vector<std::string_view> fields_of(std::string_view text, bool by_commas)
{
    if (by_commas) return gi::split_at_commas(text);
    std::vector<std::string_view> fields;
    for (std::string_view word = gi::take_word(text); !word.empty(); word = gi::take_word(text))
        fields.push_back(word);
    return fields;
}

void read_header(gi::TextLine const& line)
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

TimedPose read_pose(gi::TextLine const& line, bool by_commas, CameraAxes axes)
{
    auto const fields = fields_of(line.text, by_commas);
    if (fields.size() != kColumns.size())
        throw line.error(line.text, fmt::format("there are {} values", fields.size()), "a pose has 8",
                         fmt::format("give {}", fmt::join(kColumns, " ")));
    std::array<double, 8> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
        auto const number = gi::parse_finite(fields[i], kLargest);
        if (!number)
            throw line.error(fields[i], fmt::format("'{}' is not a number", fields[i]),
                             fmt::format("{} is one, of at most 1e15", kColumns[i]), "correct it");
        v[i] = *number;
    }
    glm::dquat const q(v[7], v[4], v[5], v[6]);
    double const length = glm::length(q);
    if (!(std::abs(length - 1) < 0.05))
        throw line.error(fields[4], fmt::format("the quaternion's length is {}", length), "that of rotations is 1",
                         "write qx qy qz qw with qw last; 0 0 0 1 is no rotation");
    glm::dquat const vision_in_graphics(0, 1, 0, 0); // half a turn about x
    glm::dquat const turn = axes == CameraAxes::graphics ? q * vision_in_graphics : q;
    return {v[0], {{v[1], v[2], v[3]}, glm::normalize(turn)}};
}

} // namespace

std::vector<TimedPose> parse_poses(std::string_view text, std::string const& file, CameraAxes axes)
{
    std::vector<TimedPose> poses;
    bool by_commas = false, begun = false;
    for (int number = 1; !text.empty(); ++number) {
        gi::TextLine const line{gi::take_until(text, '\n'), file, number};
        std::string_view const content = gi::trimmed(line.text);
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

PoseFile read_poses(std::filesystem::path const& file, FrameNumbering const& numbering, CameraAxes axes)
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
    std::string const whole = text.str();
    PoseFormat const format = pose_format(whole, file.string());
    if (numbering.order && format != PoseFormat::nuke_chan)
        throw gi::InputError(fmt::format("a rotation order with '{}'", file.string()),
                             "only Nuke's files (.chan) have angles that need one", "leave the order out");
    switch (format) {
    case PoseFormat::colmap:
        return parse_colmap_images(whole, file.string(), numbering);
    case PoseFormat::nuke_chan:
        return parse_chan(whole, file.string(), numbering);
    case PoseFormat::blender_json:
        return parse_blender_json(whole, file.string(), numbering);
    case PoseFormat::csv_or_tum:
        break;
    }
    if (numbering.first)
        throw gi::InputError(fmt::format("a number of the first frame with '{}'", file.string()),
                             "its poses have times, not numbers", "leave the number out");
    return {parse_poses(whole, file.string(), axes), {}, {}};
}

std::vector<std::string> const& rotation_order_names()
{
    static std::vector<std::string> const names{"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
    return names;
}

std::string name_of(RotationOrder order) { return rotation_order_names()[std::size_t(order)]; }

std::optional<RotationOrder> rotation_order_named(std::string const& name)
{
    auto const& names = rotation_order_names();
    auto const at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? std::nullopt : std::optional(RotationOrder(at - names.begin()));
}

std::string format_poses(std::vector<TimedPose> const& poses)
{
    std::string text = fmt::format("{}\n", fmt::join(kColumns, ","));
    for (TimedPose const& t : poses) {
        glm::dvec3 const p = t.world_from_camera.position;
        glm::dquat const q = t.world_from_camera.rotation;
        text += fmt::format("{},{},{},{},{},{},{},{}\n", t.time_s, p.x, p.y, p.z, q.x, q.y, q.z, q.w);
    }
    return text;
}

std::optional<gi::RigidPose> pose_at(std::vector<TimedPose> const& poses, double time_s, double longest_gap_s)
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
    return gi::RigidPose{glm::mix(a.world_from_camera.position, b.world_from_camera.position, s),
                         glm::normalize(a.world_from_camera.rotation * gi::exp_rotation(s * turn))};
}

std::optional<gi::RigidPose> recorded_pose(std::vector<TimedPose> const& poses, double time_s)
{
    constexpr double kRounding_s = 2e-6;
    double const first_s = poses.front().time_s, last_s = poses.back().time_s;
    if (time_s < first_s - kRounding_s || time_s > last_s + kRounding_s) return std::nullopt;
    return pose_at(poses, std::clamp(time_s, first_s, last_s));
}

} // namespace ar
