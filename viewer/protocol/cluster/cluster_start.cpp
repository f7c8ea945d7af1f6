// Start of a cluster: ranks exchange and compare their identities, and measure their clock offsets.

#include "gi/core/error.h"
#include "viewer/protocol/cluster/cluster_state.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr std::uint32_t kWire = 1; ///< version of these messages

void put(Writer& out, ProcessId const& p) { out.put(p.machine).put(p.number).put(p.started); }

ProcessId get_process(Reader& in)
{
    ProcessId p;
    p.machine = in.text();
    p.number = in.get<std::int32_t>();
    p.started = in.get<std::uint64_t>();
    return p;
}

} // namespace

void Cluster::State::hello(int from, Reader& in)
{
    Peer& p = peers[std::size_t(from)];
    ClusterIdentity& their = identities[std::size_t(from)];
    if (auto const wire = in.get<std::uint32_t>(); wire != kWire) {
        their.program = fmt::format("a lightwell with message version {}, not {}", wire, kWire);
    } else {
        p.host = in.text();
        p.process = get_process(in);
        their.program = in.text();
        their.work = in.text();
        their.content = in.get<std::uint64_t>();
    }
    p.there = true;
}

void Cluster::State::started(Reader& in)
{
    for (Peer& p : peers) {
        p.host = in.text();
        p.process = get_process(in);
        p.there = true;
    }
    is_started = true;
}

void Cluster::State::compare_identities()
{
    std::string problem, why, suggestion;
    ClusterIdentity const& mine = identities[0];
    for (int r : other_ranks()) {
        ClusterIdentity const& their = identities[std::size_t(r)];
        if (their.program != mine.program) {
            problem = fmt::format("{} runs {}, but {} runs {}", name(r), their.program, name(0), mine.program);
            why = "their pictures could differ";
            suggestion = "install the same version on all machines";
        } else if (their.work != mine.work) {
            problem =
                fmt::format("{} was started for '{}', but {} for '{}'", name(r), their.work, name(0), mine.work);
            why = "all ranks must do the same work";
            suggestion = "give all ranks the same command line";
        } else if (their.content != mine.content) {
            problem = fmt::format("the scene file of {} differs from that of {}", name(r), name(0));
            why = fmt::format("their hashes are {:016x} and {:016x}", their.content, mine.content);
            suggestion = "copy the same file to all machines";
        }
        if (!problem.empty()) break;
    }
    if (problem.empty()) return;
    std::vector<int> const others = other_ranks();
    send_to_others(Writer(MessageKind::refused).put(problem).put(why).put(suggestion));
    messenger->flush(others, 0.5);
    broken = problem;
    throw gi::InputError(problem, why, suggestion);
}

void Cluster::State::measure_clocks()
{
    constexpr int kPings = 32;
    for (int r : other_ranks())
        for (int k = 0; k < kPings && living(r); ++k) {
            int const before = pongs;
            send(r, Writer(MessageKind::ping).put(now_s()));
            await([&] { return pongs > before || !living(r); }, [r](int who) { return who == r; },
                  settings.silence_s, "while comparing clocks");
        }
}

void Cluster::State::start()
{
    if (!messenger) return;
    if (!leads()) {
        Writer out(MessageKind::hello);
        out.put(kWire).put(peers[std::size_t(rank)].host);
        put(out, here);
        send(0, std::move(out.put(identity.program).put(identity.work).put(identity.content)));
        await([this] { return is_started; }, [](int who) { return who == 0; }, settings.start_s,
              "while ranks started");
        return;
    }
    await(
        [this] {
            return std::all_of(peers.begin(), peers.end(), [](Peer const& p) { return p.there || p.lost; });
        },
        [this](int who) { return !peers[std::size_t(who)].there; }, settings.start_s, "while ranks started");
    compare_identities();
    measure_clocks();
    Writer out(MessageKind::started);
    for (Peer const& p : peers) {
        out.put(p.host);
        put(out, p.process);
    }
    send_to_others(out);
}

} // namespace viewer
