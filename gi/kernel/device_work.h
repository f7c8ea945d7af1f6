#pragma once
// What a program has asked of the device, counted as it is asked: launches, waits and bytes decide how much of a
// frame's time the device does not compute in. The simulated device counts the same.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace gi {

/// Totals since the program began, of all threads.
struct DeviceWork {
    std::uint64_t launches = 0;        ///< of kernels, those of scans and sorts included
    std::uint64_t waits = 0;           ///< of the host for the device: copies to the host, and finish()
    std::uint64_t fills = 0;           ///< of memory with one byte
    std::uint64_t uploads = 0;         ///< copies from the host
    std::uint64_t bytes_to_device = 0; ///< of these
    std::uint64_t bytes_to_host = 0;
    std::uint64_t bytes_within = 0; ///< copied from device to device

    bool operator==(DeviceWork const&) const = default;
    DeviceWork& operator-=(DeviceWork const& o);
};

DeviceWork device_work();
/// Launches by the name of the kernel.
std::map<std::string, std::uint64_t> launches_by_kernel();

namespace count_device {
void launches(char const* kernel, std::uint64_t n = 1);
void wait();
void fill();
void upload(std::size_t bytes);
void download(std::size_t bytes); ///< a wait too
void copy_within(std::size_t bytes);
} // namespace count_device

} // namespace gi
