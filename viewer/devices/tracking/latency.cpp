#include "viewer/devices/tracking/latency.h"

#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

void push(std::vector<double>& ring, std::size_t& next, double value)
{
    if (ring.size() < kLatencyWindow) {
        ring.push_back(value);
        next = ring.size() % kLatencyWindow;
    } else {
        ring[next] = value;
        next = (next + 1) % kLatencyWindow;
    }
}

} // namespace

void LatencyMeter::note(double received_s)
{
    ++packets_;
    push(arrivals_s_, next_arrival_, received_s);
}

void LatencyMeter::note(double received_s, double measured_s)
{
    note(received_s);
    push(delays_s_, next_delay_, received_s - measured_s);
}

Latency LatencyMeter::estimate() const
{
    Latency l;
    l.packets = packets_;
    l.has_sender_time = !delays_s_.empty();
    if (l.has_sender_time) {
        std::vector<double> d = delays_s_;
        std::sort(d.begin(), d.end());
        l.offset_s = d.front();
        auto const ms = [&](double share) { return 1e3 * (gi::quantile_of_sorted(d, share) - d.front()); };
        l.delay_p50_ms = ms(0.5);
        l.delay_p95_ms = ms(0.95);
        l.delay_p99_ms = ms(0.99);
        l.delay_max_ms = ms(1);
    }
    std::vector<double> a = arrivals_s_;
    std::sort(a.begin(), a.end());
    if (a.size() < 2) return l;
    l.rate_hz = a.back() > a.front() ? double(a.size() - 1) / (a.back() - a.front()) : 0;
    for (std::size_t i = a.size() - 1; i > 0; --i) a[i] -= a[i - 1];
    a.erase(a.begin());
    std::sort(a.begin(), a.end());
    l.interval_p50_ms = 1e3 * gi::quantile_of_sorted(a, 0.5);
    l.interval_p95_ms = 1e3 * gi::quantile_of_sorted(a, 0.95);
    l.interval_max_ms = 1e3 * a.back();
    return l;
}

std::vector<std::pair<std::string, double>> numbers(Latency const& l)
{
    return {{"packets", double(l.packets)},         {"rate_hz", l.rate_hz},
            {"clock_offset_s", l.offset_s},         {"delay_p50_ms", l.delay_p50_ms},
            {"delay_p95_ms", l.delay_p95_ms},       {"delay_p99_ms", l.delay_p99_ms},
            {"delay_max_ms", l.delay_max_ms},       {"interval_p50_ms", l.interval_p50_ms},
            {"interval_p95_ms", l.interval_p95_ms}, {"interval_max_ms", l.interval_max_ms}};
}

} // namespace viewer
