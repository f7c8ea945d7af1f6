#pragma once
// Statistics of the delay and regularity of samples, for the frame log.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace viewer {

/// Statistics of the last kLatencyWindow packets. Delays are relative to the fastest of them,
/// whose own delay is unknown.
struct Latency {
    std::uint64_t packets = 0;
    bool has_sender_time = false; ///< if false, delays are 0
    double offset_s = 0;          ///< received - measured of the fastest, s: our clock - the sender's
    double delay_p50_ms = 0, delay_p95_ms = 0, delay_p99_ms = 0, delay_max_ms = 0;
    double interval_p50_ms = 0, interval_p95_ms = 0, interval_max_ms = 0; ///< between arrivals
    double rate_hz = 0;                                                   ///< arrivals per second
};

inline constexpr std::size_t kLatencyWindow = 1024;

class LatencyMeter {
public:
    /// Adds one packet; times in s.
    void note(double received_s);
    void note(double received_s, double measured_s);
    /// Call when the sender's clock was set.
    void forget_delays() { delays_s_.clear(); }
    Latency estimate() const;

private:
    std::uint64_t packets_ = 0;
    std::vector<double> delays_s_, arrivals_s_; ///< ring buffers
    std::size_t next_delay_ = 0, next_arrival_ = 0;
};

/// Names with units ("delay_p95_ms") and values, for logs.
std::vector<std::pair<std::string, double>> numbers(Latency const& latency);

} // namespace viewer
