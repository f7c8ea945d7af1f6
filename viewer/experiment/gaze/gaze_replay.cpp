#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/experiment/gaze/lsl_gaze.h"

#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

class GazeReplay : public GazeSource {
public:
    GazeReplay(std::string file, double now_s) : file_(std::move(file)), start_s_(now_s)
    {
        samples_ = study::read_gaze_csv(gi::read_text(file_, std::size_t(1) << 28), file_);
        double const step_s =
            samples_.size() > 1 ? (samples_.back().time_s - samples_.front().time_s) / double(samples_.size() - 1)
                                : 1;
        length_s_ = samples_.back().time_s - samples_.front().time_s + step_s;
    }

    std::vector<study::GazeSample> take(GazePlace const& place, double now_s) override
    {
        std::vector<study::GazeSample> due;
        while (true) {
            study::GazeSample s = samples_[next_];
            s.time_s = start_s_ + s.time_s - samples_.front().time_s + length_s_ * double(rounds_);
            if (s.time_s > now_s) return due;
            s.x_px -= 0.5 * place.window_px.x;
            s.y_px -= 0.5 * place.window_px.y;
            due.push_back(s);
            if (++next_ < samples_.size()) continue;
            next_ = 0;
            ++rounds_;
        }
    }

    std::vector<std::pair<std::string, std::string>> about() const override
    {
        return {{"gaze_source", "replay of " + file_},
                {"gaze_rate_hz", fmt::format("{:.4g}", study::summarise(samples_).rate_hz)}};
    }

private:
    std::string file_;
    double start_s_, length_s_ = 1;
    std::vector<study::GazeSample> samples_;
    std::size_t next_ = 0, rounds_ = 0;
};

} // namespace

std::unique_ptr<GazeSource> open_gaze(std::string const& what, double now_s)
{
    if (what == "lsl" || what.starts_with("lsl:")) return open_lsl_gaze(what == "lsl" ? "" : what.substr(4));
    return std::make_unique<GazeReplay>(what, now_s);
}

} // namespace viewer
