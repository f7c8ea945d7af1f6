#pragma once
// Data by which a monitor describes itself (VESA E-EDID 1.4).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

struct MonitorIdentity {
    std::string maker;                  ///< "DEL"
    std::string name;                   ///< "DELL U2720Q"; else the product's number
    std::string serial;                 ///< text or number; empty = none
    double width_cm = 0, height_cm = 0; ///< whole centimetres; 0 = not said
    int year = 0;                       ///< of manufacture
};

/// None if the bytes are no EDID (header, checksum).
std::optional<MonitorIdentity> parse_edid(std::vector<unsigned char> const& bytes);
/// The monitor at a connector as X11 and GLFW name it: "DP-1", "HDMI-1" (the kernel's HDMI-A-1). None where the
/// kernel does not know it. @param drm  folder of the kernel's connectors
std::optional<MonitorIdentity> monitor_at(std::string const& connector,
                                          std::filesystem::path const& drm = "/sys/class/drm");
/// "DELL U2720Q 8KV9X13 (2020)"
std::string to_text(MonitorIdentity const& monitor);

} // namespace viewer
