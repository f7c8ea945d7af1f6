// How long the filters take: a rendered picture, one thread, the best of 20 calls.
//   bench_denoise_time PICTURE.exr      with all layers, such as lightwell render writes

#include "gi/filter/denoise.h"
#include "gi/image_io/picture_file.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace {

double best_ms(gi::Picture const& picture, gi::DenoiseSettings const& settings)
{
    double best = HUGE_VAL;
    for (int i = 0; i < 20; ++i) {
        gi::Picture copy = picture;
        auto const start = std::chrono::steady_clock::now();
        gi::denoise(copy, settings);
        std::chrono::duration<double, std::milli> const d = std::chrono::steady_clock::now() - start;
        best = std::min(best, d.count());
    }
    return best;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        fmt::print(stderr, "usage: bench_denoise_time PICTURE.exr\n");
        return 2;
    }
    gi::Picture const picture = gi::read_picture(argv[1]);
    for (int iterations = 1; iterations <= gi::kMaxIterations; ++iterations)
        fmt::print("atrous, {} iterations: {:.1f} ms\n", iterations,
                   best_ms(picture, {gi::Denoiser::atrous, iterations, 4, 1}));
    for (int const window : {3, 4, 8})
        fmt::print("discontinuity, {} x {}: {:.1f} ms\n", window, window,
                   best_ms(picture, {gi::Denoiser::discontinuity, 1, window, 1}));
}
