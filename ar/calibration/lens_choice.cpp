#include "ar/calibration/lens_choice.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

LensTrial tried(LensModel lens, std::vector<BoardView> const& views, glm::ivec2 size_px)
{
    constexpr std::size_t kGroups = 5;
    LensTrial trial;
    trial.lens = lens;
    LensOptions const keep_all{0, 0};
    try {
        LensCalibration const whole = calibrate_lens(views, size_px, lens, keep_all);
        check(whole.camera, name_of(lens));
        trial.fitted_rms_px = whole.rms_px;
        double squares = 0, count = 0;
        for (std::size_t group = 0; group < std::min(kGroups, views.size()); ++group) {
            std::vector<BoardView> fitted, left_out;
            for (std::size_t i = 0; i < views.size(); ++i)
                (i % kGroups == group ? left_out : fitted).push_back(views[i]);
            CameraModel const camera = calibrate_lens(fitted, size_px, lens, keep_all).camera;
            for (BoardView const& v : left_out) {
                auto const pose = camera_from_board(camera, v);
                double const error = pose ? rms(residuals(camera, *pose, v)) : 100;
                squares += error * error * double(v.pixels.size());
                count += double(v.pixels.size());
            }
        }
        trial.validated_rms_px = std::sqrt(squares / count);
    } catch (gi::InputError const& e) {
        trial.failed = e.what();
    }
    return trial;
}

} // namespace

LensChoice choose_lens(std::vector<BoardView> const& views, glm::ivec2 size_px, LensOptions const& options)
{
    // Leave out outliers of the most common model: their errors would dominate the choice.
    LensCalibration const first = calibrate_lens(views, size_px, LensModel::radial_tangential, options);
    std::vector<BoardView> good;
    for (std::size_t i = 0; i < views.size(); ++i)
        if (first.views[i].used) good.push_back(views[i]);
    LensChoice choice;
    double least = 1e30;
    for (LensModel const lens :
         {LensModel::pinhole, LensModel::fisheye, LensModel::radial_tangential, LensModel::rational}) {
        choice.trials.push_back(tried(lens, good, size_px));
        if (choice.trials.back().failed.empty()) least = std::min(least, choice.trials.back().validated_rms_px);
    }
    for (LensTrial const& t : choice.trials) {
        if (!t.failed.empty() || t.validated_rms_px > 1.02 * least) continue;
        choice.chosen = t.lens;
        choice.why =
            fmt::format("{} has {} coefficients and misses unseen views by {:.3f} px; the least of all is {:.3f}",
                        name_of(t.lens), coefficient_count(t.lens), t.validated_rms_px, least);
        return choice;
    }
    throw gi::InputError("no lens model fits the views", choice.trials.front().failed,
                         "take more pictures of the board");
}

} // namespace ar
