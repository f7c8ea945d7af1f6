// What the filters leave of the error of a picture, and how long they take.
//   bench_denoise_error NOISY.exr REFERENCE.exr [FILTER...]      with all layers, such as lightwell render writes

#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/image_io/picture_file.h"
#include "gi/metrics/compare.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace {

void run(int argc, char** argv)
{
    gi::Picture const noisy = gi::read_picture(argv[1]), reference = gi::read_picture(argv[2]);
    std::vector<std::string> names(argv + 3, argv + argc);
    if (names.empty()) names = gi::filter_names();
    for (std::string const& name : names) {
        double best_ms = HUGE_VAL;
        gi::Picture filtered;
        for (int i = 0; i < 5; ++i) {
            filtered = noisy;
            auto const start = std::chrono::steady_clock::now();
            gi::denoise(filtered, gi::find_filter(name));
            std::chrono::duration<double, std::milli> const d = std::chrono::steady_clock::now() - start;
            best_ms = std::min(best_ms, d.count());
        }
        fmt::print("{:14}", name);
        for (gi::NamedValue const& v :
             gi::compare(filtered, reference, {"relmse", "flip", "bias"}, "color").values)
            if (v.name == "relmse" || v.name == "flip" || v.name == "bias")
                fmt::print(" {} {:.4f}", v.name, v.value);
        fmt::print(" ms {:.1f}\n", best_ms);
    }
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 3) {
        fmt::print(stderr, "usage: bench_denoise_error NOISY.exr REFERENCE.exr [FILTER...]\n");
        return 2;
    }
    try {
        run(argc, argv);
    } catch (gi::InputError const& e) {
        fmt::print(stderr, "{}\n", e.what());
        return 2;
    }
}
