#pragma once
// Processor time and waits: limits on them hold also where other programs have the processor meanwhile.

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace gi::test {

/// Of all threads of this process and of the children that have ended, s. What waits for ever meets the time limit
/// of the test.
inline double processor_s()
{
    double sum_s = 0;
    for (int const whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used{};
        getrusage(whose, &used);
        for (timeval const& t : {used.ru_utime, used.ru_stime})
            sum_s += double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    }
    return sum_s;
}

/// Of a process that still runs, s.
inline double processor_s_of(pid_t process)
{
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string text((std::istreambuf_iterator<char>(in)), {});
    std::istringstream words(text.substr(text.rfind(')') + 2)); // state, parent, ...; ticks are the 12th and 13th
    std::string skipped;
    for (int k = 0; k < 11; ++k) words >> skipped;
    double user = 0, system = 0;
    words >> user >> system;
    return (user + system) / double(sysconf(_SC_CLK_TCK));
}

/// How often this thread has waited so far: for a time, a file, another thread.
inline long waits()
{
    rusage used{};
    getrusage(RUSAGE_THREAD, &used);
    return used.ru_nvcsw;
}

} // namespace gi::test
