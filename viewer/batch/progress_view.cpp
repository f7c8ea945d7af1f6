#include "viewer/batch/progress_view.h"

#include <fmt/format.h>

namespace viewer::batch {

void ProgressView::update(Counts const& now)
{
    if (done_before_ == SIZE_MAX) done_before_ = now.done;
    double const spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    double const rate = spent > 0 ? double(now.done - done_before_) / spent : 0;
    std::size_t const left = now.total - now.done - now.failed;
    std::string text = fmt::format("{} of {} done, {} running", now.done, now.total, now.running);
    if (now.failed > 0) text += fmt::format(", {} failed", now.failed);
    if (rate > 0) text += fmt::format(", {:.2g}/s, {} left", rate, gi::text_of_seconds(double(left) / rate));
    bar_.update(now.total == 0 ? 1 : double(now.done + now.failed) / double(now.total), text);
}

} // namespace viewer::batch
