#include "ar/pose/pose_import.h"

#include "gi/core/text.h"
#include "gi/core/yaml.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>

namespace ar {
namespace {

constexpr double kFarthest = 1e9;
constexpr double kMostFrames = 1e9;
glm::dquat const kVisionInGraphics(0, 1, 0, 0); ///< half a turn about x

struct NumberedPose {
    double frame = 0;
    gi::RigidPose world_from_camera;
    int line = 0;
};

/// By frame number. @throws gi::InputError a number twice, no poses, all before the first frame
PoseFile timed(std::vector<NumberedPose> poses, std::string const& file, FrameNumbering const& numbering)
{
    if (poses.empty())
        throw gi::InputError(gi::TextLocation{file, 0, 0}, "there are no poses",
                             "every line is empty or a comment",
                             "export the camera's animation, a line for each frame");
    std::stable_sort(poses.begin(), poses.end(),
                     [](NumberedPose const& a, NumberedPose const& b) { return a.frame < b.frame; });
    double const first = numbering.first.value_or(poses.front().frame);
    if (poses.back().frame < first)
        throw gi::InputError(gi::TextLocation{file, poses.back().line, 1},
                             fmt::format("the last pose is of frame {:.15g}", poses.back().frame),
                             fmt::format("the first frame is number {:.15g}", first), "name a smaller number");
    PoseFile out{{}, first, {}};
    for (std::size_t k = 0; k < poses.size(); ++k) {
        if (k > 0 && poses[k].frame == poses[k - 1].frame)
            throw gi::InputError(gi::TextLocation{file, poses[k].line, 1},
                                 fmt::format("frame {:.15g} is there twice", poses[k].frame),
                                 "a camera has one pose at a time", "remove one of the two");
        out.poses.push_back({(poses[k].frame - first) / numbering.frames_per_s, poses[k].world_from_camera});
    }
    return out;
}

double number(gi::TextLine const& line, std::string_view word, char const* what, double most = kFarthest)
{
    auto const value = gi::parse_finite(word, most);
    if (!value)
        throw line.error(word.empty() ? line.text : word, fmt::format("'{}' is not a number", word),
                         fmt::format("{} is one", what),
                         "write numbers with a point, such as -1.25, separated by blanks");
    return *value;
}

glm::dquat unit(glm::dquat const& q, gi::InputError const& problem)
{
    if (!(std::abs(glm::length(q) - 1) < 0.05)) throw problem;
    return glm::normalize(q);
}

std::vector<std::string_view> words_of(std::string_view text)
{
    std::vector<std::string_view> words;
    for (std::string_view w = gi::take_word(text); !w.empty(); w = gi::take_word(text)) words.push_back(w);
    return words;
}

/// "walk/frame_0012.png" -> 0012; empty = none
std::string_view last_number(std::string_view name)
{
    std::size_t end = name.find_last_of('.');
    if (end == std::string_view::npos) end = name.size();
    while (end > 0 && !std::isdigit(static_cast<unsigned char>(name[end - 1]))) --end;
    std::size_t begin = end;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1]))) --begin;
    return name.substr(begin, end - begin);
}

double frame_of(gi::TextLine const& line, std::string_view name)
{
    std::string_view const digits = last_number(name);
    if (digits.empty())
        throw line.error(name, fmt::format("the name '{}' has no number", name),
                         "frames are ordered by the numbers of their pictures", "name pictures like 000012.png");
    auto const frame = gi::parse_finite(digits, kMostFrames);
    if (!frame)
        throw line.error(digits, fmt::format("the number {} is more than {:g}", digits, kMostFrames),
                         "frames are numbered one by one; this may be a time",
                         "name pictures like 000012.png, or write a TUM file with times in seconds");
    return *frame;
}

/// @param angles_deg  about x, y and z
glm::dquat turned(glm::dvec3 angles_deg, RotationOrder order)
{
    glm::dquat turn(1, 0, 0, 0);
    for (char const axis : name_of(order)) {
        int const i = axis - 'X';
        glm::dvec3 about(0);
        about[i] = 1;
        turn = glm::angleAxis(glm::radians(angles_deg[i]), about) * turn;
    }
    return turn;
}

/// The line behind an image's: nothing but X Y POINT3D_ID, each a number.
void check_points(gi::TextLine const& line)
{
    auto const words = words_of(line.text);
    bool const are_points = words.size() % 3 == 0 && std::all_of(words.begin(), words.end(), [](auto const& w) {
                                return gi::parse_finite(w).has_value();
                            });
    if (!are_points)
        throw line.error(gi::trimmed(line.text), "this is no line of points",
                         "each image has two lines, the second X Y POINT3D_ID ... or empty",
                         "keep empty lines when images.txt is edited");
}

} // namespace

PoseFormat pose_format(std::string_view text, std::string const& file)
{
    std::string const extension = std::filesystem::path(file).extension().string();
    if (extension == ".chan") return PoseFormat::nuke_chan;
    if (extension == ".json") return PoseFormat::blender_json;
    while (!text.empty()) {
        std::string_view const line = gi::trimmed(gi::take_until(text, '\n'));
        if (line.empty() || line.front() == '#') continue;
        bool const is_csv = line.find(',') != std::string_view::npos;
        return !is_csv && words_of(line).size() >= 10 ? PoseFormat::colmap : PoseFormat::csv_or_tum;
    }
    return PoseFormat::csv_or_tum;
}

PoseFile parse_colmap_images(std::string_view text, std::string const& file, FrameNumbering const& numbering)
{
    constexpr std::array<char const*, 8> names{"IMAGE_ID", "QW", "QX", "QY", "QZ", "TX", "TY", "TZ"};
    std::vector<NumberedPose> poses;
    for (int n = 1; !text.empty(); ++n) {
        gi::TextLine const line{gi::take_until(text, '\n'), file, n};
        std::string_view const content = gi::trimmed(line.text);
        if (content.empty() || content.front() == '#') continue;
        auto const words = words_of(content);
        if (words.size() < 10)
            throw line.error(
                content, fmt::format("there are {} values", words.size()), "an image has 10",
                "write IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line of points, maybe empty");
        std::array<double, 8> v{};
        for (std::size_t k = 0; k < v.size(); ++k) v[k] = number(line, words[k], names[k]);
        double const frame = frame_of(line, content.substr(std::size_t(words[9].data() - content.data())));
        glm::dquat const turn = unit({v[1], v[2], v[3], v[4]},
                                     line.error(words[1], "the quaternion's length is not 1",
                                                "that of rotations is 1", "write QW QX QY QZ with QW first"));
        poses.push_back({frame, inverse(gi::RigidPose{{v[5], v[6], v[7]}, turn}), n});
        check_points({gi::take_until(text, '\n'), file, ++n});
    }
    return timed(std::move(poses), file, numbering);
}

PoseFile parse_chan(std::string_view text, std::string const& file, FrameNumbering const& numbering)
{
    constexpr std::array<char const*, 7> names{"the frame", "TX", "TY", "TZ", "RX", "RY", "RZ"};
    RotationOrder const order = numbering.order.value_or(RotationOrder::zxy);
    std::vector<NumberedPose> poses;
    for (int n = 1; !text.empty(); ++n) {
        gi::TextLine const line{gi::take_until(text, '\n'), file, n};
        std::string_view const content = gi::trimmed(line.text);
        if (content.empty() || content.front() == '#') continue;
        auto const words = words_of(content);
        if (words.size() != 7 && words.size() != 8)
            throw line.error(content, fmt::format("there are {} values", words.size()),
                             "a pose has 7, or 8 with a fov", "write FRAME TX TY TZ RX RY RZ");
        std::array<double, 7> v{};
        for (std::size_t k = 0; k < v.size(); ++k) v[k] = number(line, words[k], names[k]);
        glm::dquat const turn = turned({v[4], v[5], v[6]}, order);
        poses.push_back({v[0], {{v[1], v[2], v[3]}, glm::normalize(turn * kVisionInGraphics)}, n});
    }
    PoseFile out = timed(std::move(poses), file, numbering);
    out.order = order;
    return out;
}

PoseFile parse_blender_json(std::string const& text, std::string const& file, FrameNumbering numbering)
{
    gi::Yaml const root = gi::Yaml::parse(text, file, "camera");
    if (!root.has("lightwell_camera") || root.at("lightwell_camera").integer(0, 1000) != 1)
        throw root.error("no 'lightwell_camera: 1'", "this may be a file of another kind",
                         "write it with the script in docs/ar.md");
    root.only_keys({"lightwell_camera", "fps", "frames"});
    numbering.frames_per_s = root.needed("fps", "24").number(0.01, 1e4);
    glm::dquat const y_up = glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0)); // from z up
    std::vector<NumberedPose> poses;
    for (gi::Yaml const& f : root.needed("frames", "[]").items(0, 10000000)) {
        f.only_keys({"frame", "position", "rotation_wxyz"});
        auto const q = f.needed("rotation_wxyz", "[1, 0, 0, 0]").numbers(4, -1.1, 1.1);
        auto const p = f.needed("position", "[0, 0, 0]").numbers(3, -kFarthest, kFarthest);
        glm::dquat const turn =
            unit({q[0], q[1], q[2], q[3]},
                 f.at("rotation_wxyz")
                     .error("the quaternion's length is not 1", "that of rotations is 1", "write w, x, y, z"));
        poses.push_back({f.needed("frame", "1").number(-kMostFrames, kMostFrames),
                         {y_up * glm::dvec3(p[0], p[1], p[2]), glm::normalize(y_up * turn * kVisionInGraphics)},
                         f.place().line});
    }
    return timed(std::move(poses), file, numbering);
}

} // namespace ar
