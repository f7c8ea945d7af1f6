#include "gi/core/progress.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace gi {

std::string text_of_seconds(double seconds)
{
    auto const s = long(std::min(std::max(seconds, 0.0), 1e9) + 0.5);
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return s % 60 == 0 ? fmt::format("{} min", s / 60) : fmt::format("{} min {} s", s / 60, s % 60);
    long const minutes = (s + 30) / 60;
    return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

void say_estimate(std::string const& task, double seconds, std::string const& how)
{
    if (seconds < 3) return;
    std::fputs(fmt::format("{}: about {} ({})\n", task, text_of_seconds(seconds), how).c_str(), stderr);
}

ProgressBar::ProgressBar(std::string label, bool enabled)
    : label_(std::move(label)),
      enabled_(enabled && isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      last_(start_)
{
}

void ProgressBar::update(double fraction, std::string const& detail)
{
    using namespace std::chrono_literals;
    auto const now = std::chrono::steady_clock::now();
    if (!enabled_ || (drawn_ && now - last_ < 100ms)) return;
    last_ = now;
    drawn_ = true;
    constexpr int kWidth = 30;
    double const f = std::clamp(fraction, 0.0, 1.0);
    int const filled = int(f * kWidth);
    double const spent = std::chrono::duration<double>(now - start_).count();
    std::string const left = f > 0.005 ? text_of_seconds(spent * (1 - f) / f) + " left" : "";
    std::string line =
        fmt::format("\r\033[K{} [{}{}] {:3.0f} % {} {}", label_, std::string(std::size_t(filled), '#'),
                    std::string(std::size_t(kWidth - filled), '.'), 100 * f, left, detail);
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
}

ProgressBar::~ProgressBar()
{
    if (drawn_) std::fputs("\r\033[K", stderr);
}

} // namespace gi
