#include "gi/kernel/device_work.h"

#include <mutex>

namespace gi {
namespace {

struct Counted {
    std::mutex mutex;
    DeviceWork work;
    std::map<std::string, std::uint64_t> by_kernel;
};

Counted& counted()
{
    static Counted all;
    return all;
}

template <class Change>
void change(Change const& f)
{
    Counted& all = counted();
    std::scoped_lock const lock(all.mutex);
    f(all);
}

} // namespace

DeviceWork& DeviceWork::operator-=(DeviceWork const& o)
{
    launches -= o.launches;
    waits -= o.waits;
    fills -= o.fills;
    uploads -= o.uploads;
    bytes_to_device -= o.bytes_to_device;
    bytes_to_host -= o.bytes_to_host;
    bytes_within -= o.bytes_within;
    return *this;
}

DeviceWork device_work()
{
    std::scoped_lock const lock(counted().mutex);
    return counted().work;
}

std::map<std::string, std::uint64_t> launches_by_kernel()
{
    std::scoped_lock const lock(counted().mutex);
    return counted().by_kernel;
}

namespace count_device {

void launches(char const* kernel, std::uint64_t n)
{
    change([&](Counted& all) {
        all.work.launches += n;
        all.by_kernel[kernel] += n;
    });
}
void wait()
{
    change([](Counted& all) { ++all.work.waits; });
}
void fill()
{
    change([](Counted& all) { ++all.work.fills; });
}
void upload(std::size_t bytes)
{
    change([bytes](Counted& all) {
        ++all.work.uploads;
        all.work.bytes_to_device += bytes;
    });
}
void download(std::size_t bytes)
{
    change([bytes](Counted& all) {
        ++all.work.waits;
        all.work.bytes_to_host += bytes;
    });
}
void copy_within(std::size_t bytes)
{
    change([bytes](Counted& all) { all.work.bytes_within += bytes; });
}

} // namespace count_device
} // namespace gi
