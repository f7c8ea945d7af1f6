#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/arguments.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/devices/tracking/dtrack.h"
#include "viewer/devices/tracking/known_walk.h"
#include "viewer/devices/tracking/tracker_hub.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <random>
#include <thread>

namespace viewer {
namespace {

struct TrackOptions {
    std::string type = "osc", file, device, controls, address = "127.0.0.1", out, head = "head",
                left_hand = "left_hand", right_hand = "right_hand", left_foot = "left_foot",
                right_foot = "right_foot";
    int port = -1, seed = 0;
    double seconds = 10, rate_hz = 60, loss = 0, jitter_ms = 0, frame_rate_hz = 0;
    bool json = false, quiet = false;
};

/// Accepts UDP ports from `least` to 65535.
CLI::Validator port_from(int least)
{
    return CLI::Validator(
        [least](std::string& text) {
            int port = 0;
            bool const is_port = CLI::detail::lexical_cast(text, port) && port >= least && port <= 65535;
            return is_port ? std::string() : fmt::format("'{}' is no whole number from {} to 65535", text, least);
        },
        fmt::format("in [{} - 65535]", least));
}

TrackerType type_of(std::string const& name)
{
    return name == "osc"      ? TrackerType::osc
           : name == "dtrack" ? TrackerType::dtrack
           : name == "vrpn"   ? TrackerType::vrpn
                              : TrackerType::file;
}

bool wait_until(double time_s, gi::StopRequest const& stop)
{
    while (!stop.requested()) {
        double const left = time_s - steady_seconds();
        if (left <= 0) return true;
        std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, 0.05)));
    }
    return false;
}

int run_walk(TrackOptions const& o)
{
    check_outputs({o.out}, {});
    auto const samples = known_walk_samples(o.seconds, o.rate_hz);
    gi::write_text(o.out, format_tracker_file(samples));
    fmt::print("{}\n", o.out);
    return 0;
}

struct Outgoing {
    double at_s = 0;
    std::vector<unsigned char> bytes;
};

/// DTrack numbers bodies instead of naming them: the head is body 0, the hands are flysticks 0 (left) and 1
/// (right), the feet are bodies 1 (left) and 2 (right).
std::string dtrack_name(std::string const& body)
{
    constexpr std::array<char const*, kBodies> kIds{"0", "flystick0", "flystick1", "1", "2"};
    for (std::size_t b = 0; b < kBodies; ++b)
        if (body == kBodyNames[b]) return kIds[b];
    return body;
}

/// VRPN numbers sensors: head 0, left hand 1, right hand 2, left foot 3, right foot 4.
std::string vrpn_name(std::string const& body)
{
    for (std::size_t b = 0; b < kBodies; ++b)
        if (body == kBodyNames[b]) return std::to_string(b);
    return body;
}

/// One packet for all samples of the same time, with simulated loss and jitter, in the order of sending.
std::vector<Outgoing> packets_of(std::vector<TrackerSample> samples, TrackOptions const& o, std::size_t& lost)
{
    std::mt19937 rng{unsigned(o.seed)};
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<Outgoing> packets;
    std::uint64_t frame = 0;
    double const first = *samples.front().measured_s;
    for (std::size_t i = 0; i < samples.size();) {
        double const time_s = *samples[i].measured_s;
        std::vector<TrackerSample> together;
        for (; i < samples.size() && *samples[i].measured_s == time_s; ++i) together.push_back(samples[i]);
        ++frame;
        if (uniform(rng) < o.loss) {
            ++lost;
            continue;
        }
        Outgoing p;
        p.at_s = time_s - first + 1e-3 * o.jitter_ms * uniform(rng);
        if (o.type == "osc") {
            p.bytes = format_osc(together, frame);
        } else {
            for (TrackerSample& s : together) s.body = dtrack_name(s.body);
            std::string const text = format_dtrack(together, frame);
            p.bytes.assign(text.begin(), text.end());
        }
        packets.push_back(std::move(p));
    }
    std::stable_sort(packets.begin(), packets.end(),
                     [](Outgoing const& a, Outgoing const& b) { return a.at_s < b.at_s; });
    return packets;
}

int run_send(TrackOptions const& o)
{
    auto samples = o.file.empty() ? known_walk_samples(o.seconds, o.rate_hz) : read_tracker_file(o.file);
    double const first = *samples.front().measured_s;
    std::erase_if(samples, [&](TrackerSample const& s) { return *s.measured_s - first > o.seconds; });
    int const usual = o.type == "osc" ? kOscPort : kDTrackPort;
    UdpSender const sender(o.address, o.port < 0 ? usual : o.port);
    std::size_t lost = 0, refused = 0, sent = 0;
    auto const packets = packets_of(std::move(samples), o, lost);
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    double const start_s = steady_seconds();
    for (Outgoing const& p : packets) {
        if (!wait_until(start_s + p.at_s, stop)) break;
        ++sent;
        refused += !sender.send(p.bytes); // a missing receiver is reported only with the next packet
    }
    fmt::print("sent {} packets, left out {}, refused {}\n", sent, lost, refused);
    return stop.requested() ? interrupted_code() : 0;
}

char const* name_of(TrackState s)
{
    switch (s) {
    case TrackState::tracked:
        return "tracked";
    case TrackState::held:
        return "held";
    case TrackState::lost:
        return "lost";
    case TrackState::never:
        break;
    }
    return "never";
}

nlohmann::ordered_json tracker_json(TrackerReport const& r)
{
    nlohmann::ordered_json j;
    j["tracker"] = r.description;
    TrackerCounts const& c = r.counts;
    j["counts"] = {{"packets", c.packets},
                   {"samples", c.samples},
                   {"malformed", c.malformed},
                   {"ignored", c.ignored},
                   {"lost", c.lost},
                   {"out_of_order", c.out_of_order},
                   {"duplicate", c.duplicate},
                   {"restarts", c.restarts},
                   {"dropped_by_kernel", c.dropped_by_kernel},
                   {"connects", c.connects},
                   {"disconnects", c.disconnects}};
    if (!r.fault.empty()) j["fault"] = r.fault;
    for (auto const& [name, value] : numbers(r.latency)) j["latency"][name] = value;
    for (std::size_t b = 0; b < kBodies; ++b) {
        BodyReport const& body = r.bodies[b];
        if (!body.configured) continue;
        j["bodies"][kBodyNames[b]] = {{"state", name_of(body.state)},
                                      {"samples", body.counts.samples},
                                      {"late", body.counts.late},
                                      {"too_late", body.counts.too_late},
                                      {"dropouts", body.counts.dropouts},
                                      {"not_visible", body.not_visible},
                                      {"clock_restarts", body.clock_restarts},
                                      {"doubtful_times", body.doubtful_times}};
    }
    j["other_bodies"] = r.other_bodies;
    return j;
}

void print(TrackerSample const& s, double start_s)
{
    gi::dvec3 const p = s.pose.position;
    gi::dquat const q = s.pose.rotation;
    fmt::print("{:9.4f} {:<12} ", s.received_s - start_s, s.body);
    if (s.visible && s.parts != SampleParts::buttons)
        fmt::print("{:8.4f} {:8.4f} {:8.4f}  {:7.4f} {:7.4f} {:7.4f} {:7.4f}", p.x, p.y, p.z, q.x, q.y, q.z, q.w);
    else
        fmt::print("{}", s.visible ? "controls" : "not visible");
    if (s.buttons) fmt::print("  {:#x}", *s.buttons);
    for (double const axis : s.axes) fmt::print(" {:6.3f}", axis);
    fmt::print("\n");
}

int run_listen(TrackOptions const& o)
{
    TrackerSettings settings;
    settings.type = type_of(o.type);
    settings.address = o.address;
    settings.port = o.port;
    settings.file = o.file;
    settings.frame_rate_hz = o.frame_rate_hz;
    auto const id = [&](std::string const& name) {
        return o.type == "dtrack" ? dtrack_name(name) : o.type == "vrpn" ? vrpn_name(name) : name;
    };
    settings.device = o.device;
    settings.controls = o.controls;
    if (o.type != "vrpn" && !(o.device.empty() && o.controls.empty()))
        throw gi::InputError("--device or --controls with --type " + o.type, "only VRPN has named devices",
                             "add --type vrpn");
    if (o.type == "vrpn" && o.port >= 0)
        throw gi::InputError("--port with --type vrpn", "the server's port is part of the device",
                             "--device Tracker0@host:" + std::to_string(o.port));
    settings.head.id = id(o.head);
    settings.left_hand.id = id(o.left_hand);
    settings.right_hand.id = id(o.right_hand);
    settings.left_foot.id = id(o.left_foot);
    settings.right_foot.id = id(o.right_foot);
    if (settings.type == TrackerType::file && o.file.empty())
        throw gi::InputError("--type file needs --file", "there is nothing to play", "name one: --file walk.csv");
    TrackerHub hub({settings}, Polling::by_caller);
    fmt::print(stderr, "listening: {}\n", hub.report(0)[0].description);
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    double const start_s = steady_seconds();
    std::vector<TrackerSample> samples;
    for (double now = start_s; now < start_s + o.seconds && !stop.requested(); now = steady_seconds()) {
        samples.clear();
        hub.poll(now, &samples);
        if (!o.quiet && !o.json)
            for (TrackerSample const& s : samples) print(s, start_s);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    TrackerReport const r = hub.report(steady_seconds())[0];
    nlohmann::ordered_json const j = tracker_json(r);
    if (o.json) {
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    for (char const* const part : {"counts", "latency"})
        for (auto const& [name, value] : j[part].items()) fmt::print("{:<20} {}\n", name, value.dump());
    for (auto const& [name, body] : j["bodies"].items())
        fmt::print("{:<20} {}\n", name, body["state"].get<std::string>());
    for (std::string const& name : r.other_bodies) fmt::print("{:<20} {}\n", "also sent", name);
    if (!r.fault.empty()) fmt::print("{:<20} {}\n", "not connected", r.fault);
    return 0;
}

void add_listen(CLI::App& track, int& exit_code)
{
    auto const o = std::make_shared<TrackOptions>();
    CLI::App* const c = track.add_subcommand("listen", "Print the poses that a tracker sends, and their latency.");
    c->add_option("--type", o->type, "osc, dtrack, vrpn or file")
        ->check(CLI::IsMember({"osc", "dtrack", "vrpn", "file"}))
        ->capture_default_str();
    c->add_option("--address", o->address, "address of this machine to receive at; 0.0.0.0 = all")
        ->capture_default_str();
    c->add_option("--port", o->port, "UDP port; default: osc 9000, dtrack 5000; 0 = any")->check(port_from(0));
    c->add_option("--device", o->device,
                  "with --type vrpn: device and server, Tracker0@host or Tracker0@host:3883");
    c->add_option(
        "--controls", o->controls,
        "with --type vrpn: device of the same server with buttons and analogs; default: the tracker's own");
    c->add_option("--file", o->file, "with --type file: recorded poses (docs/trackers.md)");
    c->add_option("--seconds", o->seconds, "duration")->check(in_range(0, 1e9))->capture_default_str();
    c->add_option("--frame-rate", o->frame_rate_hz, "Hz, for senders that send a frame number but no time")
        ->check(in_range(0, 1e5));
    c->add_option("--head", o->head, "name that the sender uses for the head")->capture_default_str();
    c->add_option("--left-hand", o->left_hand, "the same for the left hand")->capture_default_str();
    c->add_option("--right-hand", o->right_hand, "the same for the right hand")->capture_default_str();
    c->add_option("--left-foot", o->left_foot, "the same for the left foot")->capture_default_str();
    c->add_option("--right-foot", o->right_foot, "the same for the right foot")->capture_default_str();
    c->add_flag("--quiet", o->quiet, "print only the counts at the end, no samples");
    c->add_flag("--json", o->json, "print the counts as JSON");
    c->footer(R"(Prepared by:
  lightwell track walk --seconds 1 --out walk.csv
Examples:
  lightwell track listen --type file --file walk.csv --seconds 0.2
  lightwell track listen --type osc --port 9123 --seconds 0.2 --json

With --type dtrack the defaults are body 0 (head), flysticks 0 and 1 (left and right hand), bodies 1 and 2 (left
and right foot); with --type vrpn sensors 0 to 4 (head, left and right hand, left and right foot). Poses are printed as sent, in the tracker's own axes: x y z (m), quaternion x y z w, buttons.
Delays are relative to that of the fastest packet.)");
    c->callback([o, &exit_code] { exit_code = run_listen(*o); });
}

void add_send(CLI::App& track, int& exit_code)
{
    auto const o = std::make_shared<TrackOptions>();
    CLI::App* const c = track.add_subcommand("send", "Send recorded poses as a tracker would.");
    c->add_option("--type", o->type, "osc or dtrack")
        ->check(CLI::IsMember({"osc", "dtrack"}))
        ->capture_default_str();
    c->add_option("--file", o->file, "recorded poses (docs/trackers.md); default: a generated walk");
    c->add_option("--address", o->address, "numeric address of the receiver")->capture_default_str();
    c->add_option("--port", o->port, "UDP port; default: osc 9000, dtrack 5000")->check(port_from(1));
    c->add_option("--seconds", o->seconds, "longest duration")->check(in_range(0, 86400))->capture_default_str();
    c->add_option("--rate", o->rate_hz, "poses per second of the generated walk")
        ->check(in_range(1, 1000))
        ->capture_default_str();
    c->add_option("--loss", o->loss, "share of packets not sent")->check(in_range(0, 1))->capture_default_str();
    c->add_option("--jitter", o->jitter_ms, "random delay of packets, 0 to this, ms; packets may overtake others")
        ->check(in_range(0, 1e4))
        ->capture_default_str();
    c->add_option("--seed", o->seed, "seed of loss and jitter")->check(in_range(0, 2147483647));
    c->footer(R"(Prepared by:
  lightwell track walk --seconds 1 --out walk.csv
Examples:
  lightwell track send --type osc --file walk.csv --port 9123 --seconds 0.2
  lightwell track send --type dtrack --port 5123 --seconds 0.2 --loss 0.1 --jitter 50)");
    c->callback([o, &exit_code] { exit_code = run_send(*o); });
}

void add_walk(CLI::App& track, int& exit_code)
{
    auto const o = std::make_shared<TrackOptions>();
    CLI::App* const c =
        track.add_subcommand("walk", "Write the poses of a generated walk on a circle with head turns.");
    c->add_option("--seconds", o->seconds, "duration")->check(in_range(0, 86400))->capture_default_str();
    c->add_option("--rate", o->rate_hz, "poses per second")->check(in_range(1, 1000))->capture_default_str();
    c->add_option("-o,--out", o->out, "file to write")->required();
    c->footer(R"(Examples:
  lightwell track walk --seconds 1 --out walk.csv)");
    c->callback([o, &exit_code] { exit_code = run_walk(*o); });
}

} // namespace

void add_track(CLI::App& app, int& exit_code)
{
    CLI::App* const c = app.add_subcommand("track", about("track"));
    c->require_subcommand(1);
    add_listen(*c, exit_code);
    add_send(*c, exit_code);
    add_walk(*c, exit_code);
    c->footer(R"(Examples:
  lightwell track walk --seconds 1 --out walk.csv
  lightwell track send --file walk.csv --port 9123 --seconds 0.2)");
}

} // namespace viewer
