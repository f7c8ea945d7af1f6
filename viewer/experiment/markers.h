#pragma once
// Markers for recorders of other devices (EEG, heart, skin): a line of JSON in a UDP packet, and where the library
// is there, a sample of a Lab Streaming Layer stream of the type Markers.

#include "gi/core/report.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace viewer {

inline constexpr int kMarkerPort = 20261;

class Markers {
public:
    /// @param wanted  of the script: "udp", "lsl"   @param port  of 127.0.0.1, where packets go
    /// Throws InputError on another word, and where there is no socket. A library that is not there is counted in
    /// the report.
    Markers(std::vector<std::string> const& wanted, int port, std::string const& experiment, gi::Report& report);
    ~Markers();
    Markers(Markers const&) = delete;
    Markers& operator=(Markers const&) = delete;

    /// Never blocks. @param time_s  of what is marked, on the steady clock, which is CLOCK_MONOTONIC
    void send(double time_s, std::string const& what, nlohmann::ordered_json about = {});

private:
    struct Lsl;
    int socket_ = -1;
    int port_ = 0;
    std::unique_ptr<Lsl> lsl_;
    gi::Report& report_;
};

} // namespace viewer
