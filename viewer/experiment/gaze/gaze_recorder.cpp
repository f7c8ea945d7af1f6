#include "viewer/experiment/gaze/gaze_recorder.h"

#include "gi/core/error.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr double kStale_s = 0.2;
constexpr char const* kHeader = "t_s,x_px,y_px,pupil_mm,valid,step,shown\n";

std::filesystem::path free_table(std::filesystem::path const& folder, std::string const& stem)
{
    for (int part = 1;; ++part)
        if (auto file = folder / fmt::format("{}_part-{:02}_gaze.csv", stem, part); !std::filesystem::exists(file))
            return file;
}

} // namespace

GazeRecorder::GazeRecorder(std::unique_ptr<GazeSource> source, std::filesystem::path folder,
                           std::string const& stem)
    : source_(std::move(source)), file_(free_table(folder, stem))
{
}

void GazeRecorder::at(int step, std::string const& shown)
{
    step_ = step;
    shown_ = shown.empty() ? "-" : shown;
}

void GazeRecorder::poll(GazePlace const& place, double now_s)
{
    if (!source_) return;
    for (study::GazeSample const& s : source_->take(place, now_s)) {
        if (s.is_valid)
            rows_ +=
                fmt::format("{:.6f},{:.2f},{:.2f},{},1,{},{}\n", s.time_s, s.x_px + 0.5 * place.window_px.x,
                            s.y_px + 0.5 * place.window_px.y,
                            std::isfinite(s.pupil_mm) ? fmt::format("{:.3f}", s.pupil_mm) : "", step_, shown_);
        else
            rows_ += fmt::format("{:.6f},,,,0,{},{}\n", s.time_s, step_, shown_);
        if (s.is_valid) latest_ = s;
        if (watch_ != nullptr) watch_->take(s);
        if (captured_) captured_->push_back(s);
    }
}

std::optional<study::GazeSample> GazeRecorder::latest(double now_s) const
{
    return latest_ && now_s - latest_->time_s < kStale_s ? latest_ : std::nullopt;
}

std::vector<study::GazeSample> GazeRecorder::end_capture()
{
    auto samples = std::move(captured_).value_or(std::vector<study::GazeSample>{});
    captured_.reset();
    return samples;
}

void GazeRecorder::flush()
{
    if (rows_.empty()) return;
    bool const is_new = !std::filesystem::exists(file_);
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file_.c_str(), "ab"), std::fclose);
    std::string const text = (is_new ? kHeader : "") + rows_;
    if (!out || std::fwrite(text.data(), 1, text.size(), out.get()) != text.size() || std::fflush(out.get()) != 0)
        throw gi::InputError("cannot write '" + file_.string() + "'", std::strerror(errno),
                             "make room, or choose another record.dir");
    rows_.clear();
}

std::vector<std::pair<std::string, std::string>> GazeRecorder::about() const
{
    if (!source_) return {};
    auto facts = source_->about();
    facts.emplace_back("gaze_table", file_.filename().string());
    return facts;
}

} // namespace viewer
