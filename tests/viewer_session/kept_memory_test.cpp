#include "viewer/base/kept_memory.h"

#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <malloc.h>
#include <memory>
#include <thread>
#include <unistd.h>
#include <vector>

namespace viewer::test {
namespace {

double resident_mib()
{
    long pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return double(resident) * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// Growth of the process by what another thread has freed, in MiB.
int left_by_another_thread()
{
    keep_freed_memory();
    double const before = resident_mib();
    std::thread([] {
        constexpr std::size_t kBlock = 16 << 10;
        std::vector<std::unique_ptr<char[]>> blocks(3000); // 47 MiB
        for (auto& b : blocks) {
            b = std::make_unique_for_overwrite<char[]>(kBlock);
            std::memset(b.get(), 1, kBlock);
        }
    }).join();
    malloc_trim(0);
    return int(resident_mib() - before);
}

/// In a process of its own, where no other thread has allocated.
TEST(KeptMemory, OfAnyThreadCanBeGivenBack)
{
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "SKIPPED: AddressSanitizer keeps freed memory";
#endif
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(std::exit(left_by_another_thread() < 10 ? 0 : 1), testing::ExitedWithCode(0), "");
}

} // namespace
} // namespace viewer::test
