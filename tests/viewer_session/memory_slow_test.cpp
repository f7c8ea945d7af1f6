// A session of many changes frees the memory of methods, sizes and scenes that it no longer uses.

#include "gi/scene/generate/generate.h"
#include "viewer/base/kept_memory.h"
#include "viewer/engine/render_session.h"

#include <fstream>
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

namespace viewer::test {
namespace {

struct Memory {
    double resident_mib, in_use_mib, free_mib;
};

Memory memory_now()
{
    long pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    constexpr double kMib = 1 << 20;
    struct mallinfo2 const m = mallinfo2();
    return {double(resident) * double(sysconf(_SC_PAGESIZE)) / kMib, double(m.uordblks + m.hblkhd) / kMib,
            double(m.fordblks) / kMib};
}

/// Freed memory is kept, as in the program. Whitted ray tracing needs little, and must not
/// keep the memory of slhb's hit buffers.
TEST(SessionMemory, IsTheSameAfterManyChangesOfMethod)
{
    keep_freed_memory();
    gi::Report report;
    RenderSession session(
        [](std::string const&, gi::Report&) { return std::make_shared<gi::Scene const>(gi::generate_atrium({})); },
        0, report);
    session.apply({"scene", "atrium"});
    gi::Camera const eye = gi::generate_atrium({}).cameras.at(0);
    std::uint64_t frame = 0;
    double time_s = 0;
    std::vector<Memory> rounds;
    double most_mib = 0, after_mib = 0;
    for (int round = 0; round < 8; ++round) {
        for (char const* const method : {"slhb", "sh_grid", "lpv", "reference", "whitted", "ispm"}) {
            session.apply({"method", method});
            for (int k = 0; k < 6; ++k) {
                FrameCommand command;
                command.frame = frame++;
                command.scene_s = time_s += 0.1;
                command.light_scale = k % 2 == 0 ? 0.25 : 0.4;
                command.views.push_back({"window", eye, 640, 480, -1});
                session.render(command, {});
            }
            Memory const now = memory_now();
            most_mib = std::max(most_mib, now.resident_mib);
            if (std::string_view(method) == "whitted") after_mib = now.resident_mib;
            std::printf("%d %-10s resident %.0f, in use %.0f, free %.0f MiB\n", round, method, now.resident_mib,
                        now.in_use_mib, now.free_mib);
        }
        rounds.push_back(memory_now());
    }
    // What threads keep for themselves comes and goes: the least of the last rounds is compared.
    auto const least = [&](std::size_t first, std::size_t end, double Memory::*what) {
        double least_mib = rounds[first].*what;
        for (std::size_t k = first; k < end; ++k) least_mib = std::min(least_mib, rounds[k].*what);
        return least_mib;
    };
    EXPECT_LT(least(5, 8, &Memory::in_use_mib), 1.02 * least(0, 3, &Memory::in_use_mib));
    EXPECT_LT(least(5, 8, &Memory::resident_mib), 1.05 * least(0, 3, &Memory::resident_mib));
    EXPECT_LT(after_mib, 0.6 * most_mib) << "what a method has left is given back";
}

} // namespace
} // namespace viewer::test
