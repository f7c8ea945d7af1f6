#include "viewer/experiment/stimuli/ar_source.h"

#include "ar/pipeline/bridge.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/experiment/stimuli/prepared.h"
#include "viewer/experiment/stimuli/prepared_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

namespace fs = std::filesystem;

std::string file_name(std::size_t number) { return fmt::format("{:05}.png", number); }

std::string png_of(cv::Mat const& rgb)
{
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    std::vector<unsigned char> bytes;
    cv::imencode(".png", bgr, bytes);
    return {bytes.begin(), bytes.end()};
}

std::vector<ArPicture> read_pictures(fs::path const& folder)
{
    nlohmann::json const about = read_prepared(folder);
    std::vector<ArPicture> pictures;
    for (double const time_s : about.at("times_s")) {
        fs::path const file = folder / file_name(pictures.size());
        ArPicture p;
        p.time_s = time_s;
        p.rgb = cv::imread(file.string(), cv::IMREAD_COLOR);
        if (p.rgb.empty())
            throw gi::InputError("there is no picture '" + file.string() + "'", "it was prepared",
                                 "remove its folder and run lightwell study prepare again");
        cv::cvtColor(p.rgb, p.rgb, cv::COLOR_BGR2RGB);
        pictures.push_back(std::move(p));
    }
    return pictures;
}

/// Linear radiance of each sRGB byte.
std::array<float, 256> const& radiance_of_bytes()
{
    static std::array<float, 256> const table = [] {
        std::array<float, 256> t;
        for (std::size_t i = 0; i < 256; ++i) {
            double const v = double(i) / 255;
            t[i] = float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
        }
        return t;
    }();
    return table;
}

std::shared_ptr<LiveFrame const> frame_of(ArPicture const& p, Settings const& settings)
{
    auto frame = std::make_shared<LiveFrame>();
    frame->settings = settings;
    gi::Picture picture;
    picture.width = p.rgb.cols;
    picture.height = p.rgb.rows;
    gi::Layer& color = picture.add("color", 3);
    auto const& radiance = radiance_of_bytes();
    float* out = color.data.data();
    for (int y = 0; y < p.rgb.rows; ++y) {
        unsigned char const* const row = p.rgb.ptr(y);
        for (int k = 0; k < 3 * p.rgb.cols; ++k) *out++ = radiance[row[k]];
    }
    ViewCommand order;
    order.width = p.rgb.cols;
    order.height = p.rgb.rows;
    if (p.world_from_camera) {
        ar::CameraModel any; // only its pose matters
        any.size_px = {p.rgb.cols, p.rgb.rows};
        any.fx = any.fy = p.rgb.cols;
        order.camera = ar::gi_camera(any, *p.world_from_camera);
    }
    frame->command.views.push_back(order);
    frame->result.views.push_back({std::move(picture), {}});
    return frame;
}

} // namespace

bool prepare_ar_stimulus(StimulusSettings const& stimulus, StimulusView const& view, fs::path const& folder,
                         std::string const& key, gi::StopRequest const& stop, gi::Report& report)
{
    if (prepared_flaw(folder / key).empty()) return false;
    auto const pictures = make_ar_pictures(*stimulus.ar, view, stop, report);
    if (stop.requested()) throw gi::InputError("preparing stimuli", "it was interrupted", "start it again");
    write_prepared(folder / key, [&](fs::path const& into) -> nlohmann::json {
        nlohmann::json times = nlohmann::json::array();
        for (ArPicture const& p : pictures) {
            gi::write_text(into / file_name(times.size()), png_of(p.rgb));
            times.push_back(p.time_s);
        }
        return {{"times_s", times}, {"sha256", stimulus.sha256}};
    });
    return true;
}

ArSource::ArSource(fs::path prepared, std::string version, gi::Report& report)
    : prepared_(std::move(prepared)), version_(std::move(version)), report_(report)
{
}

ArSource::~ArSource() { stop(); }

void ArSource::stop()
{
    if (stop_) stop_->request();
    if (making_.valid()) making_.wait();
    making_ = {};
}

void ArSource::make()
{
    stop();
    stop_ = std::make_shared<gi::StopRequest>();
    making_ = std::async(std::launch::async, [ar = *stimulus_.ar, view = view_, stop = stop_, &report = report_] {
        return make_ar_pictures(ar, view, *stop, report);
    });
}

void ArSource::prepare(StimulusSettings const& stimulus, StimulusView const& view)
{
    if (view.on_walls || view.stereo != StereoMode::off)
        throw gi::InputError("an AR session on walls, in a headset or in stereo",
                             "its pictures are those of one camera", "show it in a window");
    std::string const key = prepared_key({stimulus, view}, version_);
    at_s_ = 0;
    if (key == made_of_ && !making_.valid()) return;
    stimulus_ = stimulus;
    view_ = view;
    pictures_.clear();
    frame_.reset();
    made_of_ = key;
    if (prepared_.empty()) {
        make();
        return;
    }
    if (!fs::exists(prepared_ / key / "stimulus.json"))
        throw gi::InputError(fmt::format("a stimulus of {} is not in '{}'", name_of(stimulus), prepared_.string()),
                             fmt::format("nothing was prepared for a place of {} x {} px by this version",
                                         view.size_px.x, view.size_px.y),
                             "run lightwell study prepare with the same script and --size");
    pictures_ = read_pictures(prepared_ / key);
}

/// Takes the finished pictures.
void ArSource::take()
{
    if (!making_.valid() || making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    try {
        pictures_ = making_.get();
    } catch (std::exception const& e) {
        made_of_.clear();
        throw gi::InputError("a stimulus cannot be composited", e.what(), "correct the script, or its AR session");
    }
    frame_.reset();
}

bool ArSource::is_ready()
{
    take();
    return !pictures_.empty();
}

void ArSource::change(StimulusSettings const& stimulus)
{
    if (!prepared_.empty())
        throw gi::InputError("an adjustment of prepared stimuli", "only planned levels have pictures",
                             "write stimuli: live in the block");
    stimulus_ = stimulus;
    made_of_ = prepared_key({stimulus, view_}, version_);
    make();
}

void ArSource::walk(NavigationInput const&, double)
{
    throw gi::InputError("a walk through an AR session", "its frames have the camera's viewpoint",
                         "give the free walk a scene");
}

std::shared_ptr<LiveFrame const> ArSource::newest()
{
    take();
    if (pictures_.empty()) return nullptr;
    double const at_s = view_.duration_s > 0 ? std::fmod(at_s_, view_.duration_s) : 0;
    auto const after = std::upper_bound(pictures_.begin(), pictures_.end(), at_s,
                                        [](double t, ArPicture const& p) { return t < p.time_s; });
    std::size_t const number = after == pictures_.begin() ? 0 : std::size_t(after - pictures_.begin()) - 1;
    if (!frame_ || number != frame_number_) frame_ = frame_of(pictures_[number], stimulus_.settings);
    frame_number_ = number;
    return frame_;
}

} // namespace viewer
