#include "ar/runtime/frame_truth.h"

#include "ar/capture/decode_picture.h"
#include "ar/capture/picture_source.h"
#include "ar/runtime/truth.h"
#include "gi/core/error.h"
#include "gi/core/file.h"

#include <fmt/format.h>

namespace ar {
namespace {

/// CV_8UC3 RGB. @throws gi::InputError why it cannot be used
cv::Mat read_truth(std::filesystem::path const& file, cv::Size size)
{
    std::vector<unsigned char> const bytes = gi::read_bytes(file, std::size_t(1) << 30);
    DecodedPicture const picture = decoded_picture(bytes);
    if (!picture.problem.empty())
        throw gi::InputError("'" + file.filename().string() + "' cannot be used", picture.problem,
                             "write it again");
    if (picture.pixels.size() != size)
        throw gi::InputError(fmt::format("'{}' has {} x {} pixels", file.filename().string(), picture.pixels.cols,
                                         picture.pixels.rows),
                             fmt::format("the camera's frames have {} x {}", size.width, size.height),
                             "write it of their size");
    Frame frame;
    frame.format = picture.format;
    frame.size_px = {size.width, size.height};
    frame.planes[0] = picture.pixels;
    return eight_bits_of(picture_of(frame));
}

void note(std::uint64_t& count, std::string& first, std::string const& what)
{
    if (count++ == 0) first = what;
}

} // namespace

FrameTruth::FrameTruth(std::filesystem::path const& pictures, std::vector<TimedPose> poses)
    : poses_(std::move(poses))
{
    errors_.has_poses = !poses_.empty();
    if (pictures.empty()) return;
    errors_.has_pictures = true;
    char const* const help = "name the folder truth that `ar synthesize` made";
    if (!std::filesystem::is_directory(pictures))
        throw gi::InputError("there is no folder '" + pictures.string() + "'", "it should hold the truth", help);
    FoundPictures const found = find_pictures(pictures);
    if (found.pictures.empty())
        throw gi::InputError("no pictures in '" + pictures.string() + "'", "it should hold the truth", help);
    if (!found.has_numbers)
        throw gi::InputError("the pictures of '" + pictures.string() + "' have no numbers of frames",
                             "each is the truth of the frame with its number", "name them 000012.png");
    for (NumberedPicture const& p : found.pictures) pictures_.emplace(p.number, p.file);
}

void FrameTruth::add(RunFrame const& f, FrameResult const& r)
{
    auto const truth_pose = poses_.empty() ? std::nullopt : recorded_pose(poses_, f.captured_s);
    if (truth_pose)
        errors_.poses.add(f.sequence, *truth_pose, f.estimated, f.confidence, f.state, f.world_from_camera);
    else if (errors_.has_poses)
        ++errors_.without_pose;
    if (truth_pose && f.world_from_camera) {
        errors_.position_mm.push_back(1e3 * glm::length(f.world_from_camera->position - truth_pose->position));
        errors_.rotation_deg.push_back(angle_between_deg(f.world_from_camera->rotation, truth_pose->rotation));
    }
    if (!errors_.has_pictures) return;
    std::string const frame = fmt::format("frame {}", f.sequence);
    auto const file = pictures_.find(f.sequence);
    if (file == pictures_.end()) return note(errors_.without_picture, errors_.first_without_picture, frame);
    try {
        add_picture(file->second, r);
    } catch (gi::InputError const& e) {
        note(errors_.unusable, errors_.first_unusable, frame + ": " + e.what());
    }
}

void FrameTruth::add_picture(std::filesystem::path const& file, FrameResult const& r)
{
    cv::Mat const truth = read_truth(file, r.rgb.size());
    TruthErrors const e = errors_against_truth(eight_bits_of(r.rgb), eight_bits_of(r.camera), truth);
    auto const keep = [](std::vector<double>& values, std::optional<double> v) {
        if (v) values.push_back(*v);
    };
    keep(errors_.flip_affected, e.flip_affected);
    keep(errors_.flip_elsewhere, e.flip_elsewhere);
    keep(errors_.camera_affected, e.camera_affected);
    keep(errors_.camera_elsewhere, e.camera_elsewhere);
    errors_.affected_percent.push_back(100 * e.affected);
    errors_.unaffected += e.affected == 0;
    errors_.equal += e.equals_camera;
}

std::string describe(FrameErrors const& e)
{
    if (!e.has_pictures && !e.has_poses) return {};
    std::string t = fmt::format("{:<30} {:>9} {:>9} {:>9}\n", "against the truth", "median", "95 %", "most");
    auto const line = [&](char const* name, std::vector<double> const& values) {
        if (values.empty()) {
            t += fmt::format("{:<30} {:>9} {:>9} {:>9}\n", name, "-", "-", "-");
            return;
        }
        Spread const s = spread_of(values);
        t += fmt::format("{:<30} {:>9.4f} {:>9.4f} {:>9.4f}\n", name, s.median, s.p95, s.most);
    };
    if (e.has_poses) {
        line("position error (mm)", e.position_mm);
        line("rotation error (deg)", e.rotation_deg);
    }
    if (e.has_pictures) {
        line("FLIP where it is affected", e.flip_affected);
        line("  of adding nothing", e.camera_affected);
        line("  share of the picture (%)", e.affected_percent);
        line("FLIP elsewhere", e.flip_elsewhere);
        line("  of adding nothing", e.camera_elsewhere);
    }
    if (e.unaffected > 0)
        t += fmt::format("no pixel is affected in {} of {} frames: their truth {} the camera's frame{}\n",
                         e.unaffected, e.compared(), e.equal == e.unaffected ? "is" : "does not differ from",
                         e.unaffected == e.compared() ? "; is this the folder of the truth?" : "");
    if (e.without_picture > 0)
        t += fmt::format("no truth picture: {} frames (first: {})\n", e.without_picture, e.first_without_picture);
    if (e.unusable > 0)
        t += fmt::format("truth pictures that cannot be compared: {} (first: {})\n", e.unusable, e.first_unusable);
    if (e.without_pose > 0) t += fmt::format("no true pose at their time: {} frames\n", e.without_pose);
    return t + describe(e.poses);
}

void report_losses(FrameErrors const& e, gi::Report& report)
{
    auto const lose = [&](char const* what, std::uint64_t n, std::string const& first) {
        if (n > 0) report.lose(what, n, first);
    };
    lose("frames without a truth picture", e.without_picture, e.first_without_picture);
    lose("truth pictures that cannot be compared", e.unusable, e.first_unusable);
    lose("frames without a true pose at their time", e.without_pose, {});
    lose("frames in which the truth affects no pixel: no FLIP there", e.unaffected,
         e.equal > 0 ? fmt::format("{} of them are the camera's frame, byte for byte", e.equal) : std::string());
}

} // namespace ar
