#pragma once
// Event markers for recording devices (EEG, heart rate, skin conductance): a line of JSON in a UDP packet and,
// if liblsl is installed, a sample of a Lab Streaming Layer stream of type Markers.
// docs/study/running.md lists the events and their fields.

#include "gi/core/report.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace viewer {

inline constexpr int kMarkerPort = 20261;

/// Facts common to all markers of a stream, for its description.
struct MarkerSession {
    std::string experiment, participant;
    int session = 1;
};

class Markers {
public:
    /// @param wanted  from the script: "udp", "lsl"  @param port  destination port on 127.0.0.1 Throws InputError
    /// on another word, or if no socket can be opened. A missing library is counted in the report.
    Markers(std::vector<std::string> const& wanted, int port, MarkerSession const& session, gi::Report& report);
    /// Waits half a second if anyone reads the stream, so that the last markers are sent.
    ~Markers();
    Markers(Markers const&) = delete;
    Markers& operator=(Markers const&) = delete;

    /// Sends a marker; never blocks. @param time_s  time of the event on the steady clock (CLOCK_MONOTONIC)
    void send(double time_s, std::string const& what, nlohmann::ordered_json about = {});
    /// lsl (library's version), lsl_clock_offset_s; empty without a stream.
    std::vector<std::pair<std::string, std::string>> about() const;

private:
    struct Stream;
    int socket_ = -1;
    int port_ = 0;
    std::unique_ptr<Stream> stream_;
    gi::Report& report_;
};

} // namespace viewer
