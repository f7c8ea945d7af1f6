#include "viewer/protocol/cluster/cluster_state.h"

#include "gi/core/error.h"
#include "gi/core/host_name.h"
#include "gi/core/rng.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <thread>
#include <unistd.h>
#include <utility>

namespace viewer {
namespace {

/// Yields to other processes at first and sleeps later, because waits are short while frames follow each other.
void pause(double waited_s)
{
    if (waited_s < 2e-4)
        std::this_thread::yield();
    else
        std::this_thread::sleep_for(std::chrono::microseconds(waited_s < 0.1 ? 50 : 500));
}

} // namespace

Cluster::State::State(ClusterIdentity of, ClusterSettings with) : identity(std::move(of)), settings(with)
{
    if (!(settings.silence_s > 0 && settings.start_s > 0))
        throw gi::InputError("a rank may be silent for 0 s", "every rank would be lost at once",
                             "give a time above 0");
    if (started_with_others()) {
        messenger = make_messenger();
        rank = messenger->rank();
        size = messenger->size();
    }
    here = this_process();
    peers.resize(std::size_t(size));
    identities.resize(std::size_t(size));
    Peer& self = peers[std::size_t(rank)];
    self.host = gi::host_name();
    self.process = here;
    self.there = true;
    identities[std::size_t(rank)] = identity;
}

std::string Cluster::State::name(int r) const
{
    std::string const& host = peers[std::size_t(r)].host;
    return host.empty() ? fmt::format("rank {}", r) : fmt::format("rank {} on {}", r, host);
}

std::vector<int> Cluster::State::other_ranks() const
{
    std::vector<int> all;
    for (int r = 0; r < size; ++r)
        if (r != rank) all.push_back(r);
    return all;
}

bool Cluster::State::others_living() const
{
    auto const others = other_ranks();
    return std::all_of(others.begin(), others.end(), [this](int r) { return living(r); });
}

void Cluster::State::send(int to, Writer message) { messenger->send(to, message.take()); }

void Cluster::State::send_to_others(Writer const& message)
{
    for (int r : other_ranks())
        if (living(r)) messenger->send(r, message.bytes());
}

void Cluster::State::stop(std::string const& why)
{
    broken = why;
    throw RankLoss(why);
}

void Cluster::State::lose(int r, std::string const& how)
{
    Peer& lost = peers[std::size_t(r)];
    if (lost.lost || !broken.empty() || over) return;
    std::string const text = fmt::format("{} {}", name(r), how);
    lost.lost = true;
    lost.how_lost = how;
    if (!leads() && is_leaving) return; // the leader ended after all work was done
    if (!leads()) stop(text + "; it was the leader, so no rank can continue");
    bool const stops = settings.on_loss == OnRankLoss::stop;
    messenger->send(r, Writer(MessageKind::stop).put(text + "; this one was left behind").take());
    send_to_others(stops ? Writer(MessageKind::stop).put(text)
                         : Writer(MessageKind::lost).put(std::int32_t(r)).put(text));
    if (!stops) {
        news.push_back(text + "; the others go on");
        return;
    }
    // If this process ended at once, messages not yet read by others could be lost.
    broken = text;
    auto const listens = [this](int other) {
        Peer const& p = peers[std::size_t(other)];
        return living(other) && !p.said_goodbye && state_of(p.process, here) != ProcessState::ended;
    };
    auto const others = other_ranks();
    for (double const end = now_s() + 1; now_s() < end && std::any_of(others.begin(), others.end(), listens);
         pause(1))
        take_messages();
    stop(text);
}

void Cluster::State::watch_processes()
{
    double const now = now_s();
    if (now - watched_s < 0.1) return;
    watched_s = now;
    for (int r : other_ranks()) {
        bool const matters = leads() || r == 0;
        Peer const& p = peers[std::size_t(r)];
        if (!matters || !living(r) || p.said_goodbye || state_of(p.process, here) != ProcessState::ended) continue;
        // The rank's last message explains its end better, and takes a moment to arrive through shared memory.
        for (double const end = now_s() + 0.05; now_s() < end; pause(1)) take_messages();
        if (living(r) && !p.said_goodbye)
            lose(r, fmt::format("has died (its process {} has ended)", p.process.number));
    }
}

void Cluster::State::show_life()
{
    double const now = now_s();
    if (now - lived_s < std::min(1.0, settings.silence_s / 5)) return;
    lived_s = now;
    if (leads())
        send_to_others(Writer(MessageKind::alive));
    else if (living(0))
        send(0, Writer(MessageKind::alive));
}

void Cluster::State::take_messages()
{
    for (Message const& m : messenger->poll()) {
        Peer& from = peers[std::size_t(m.from)];
        if (from.lost) continue; // the others continue without it
        from.heard_s = listened_s;
        handle(m);
    }
}

void Cluster::State::pump()
{
    if (!broken.empty()) throw RankLoss(broken);
    if (over) return;
    constexpr double kMostGap = 0.1; // longer gaps do not count as listening, so that an overloaded machine
                                     // reports no other rank
    double const now = now_s();
    listened_s += std::min(kMostGap, now - std::exchange(pumped_s, now));
    take_messages();
    watch_processes();
    show_life();
}

void Cluster::State::await(std::function<bool()> const& condition, std::function<bool(int)> const& waits_for,
                           double silence_s, std::string const& what_for)
{
    double const start = now_s();
    pump();
    double const from = listened_s;
    while (true) {
        pump();
        if (condition()) return;
        for (int r : other_ranks())
            if (living(r) && waits_for(r)) lose_if_silent(r, from, silence_s, what_for);
        pause(now_s() - start);
    }
}

void Cluster::State::lose_if_silent(int r, double from_s, double silence_s, std::string const& what_for)
{
    // A rank that was not listening cannot judge that others were silent.
    double const silent = listened_s - std::max(from_s, peers[std::size_t(r)].heard_s);
    if (silent < silence_s) return;
    bool const stopped = state_of(peers[std::size_t(r)].process, here) == ProcessState::stopped;
    lose(r, fmt::format("has not answered for {:.1f} s ({}{})", silent, what_for,
                        stopped ? "; its process is stopped" : ""));
}

void Cluster::State::handle(Message const& message)
{
    Reader in(message.bytes);
    Peer& from = peers[std::size_t(message.from)];
    switch (in.get<MessageKind>()) {
    case MessageKind::hello:
        return hello(message.from, in);
    case MessageKind::refused: {
        std::string const problem = in.text(), why = in.text(), suggestion = in.text();
        broken = problem;
        throw gi::InputError(problem, why, suggestion);
    }
    case MessageKind::started:
        return started(in);
    case MessageKind::ping: {
        Echo echo;
        echo.sent_s = in.get<double>();
        echo.received_s = echo.answered_s = now_s();
        return send(0, Writer(MessageKind::pong).put(echo));
    }
    case MessageKind::pong:
        from.clock.add(in.get<Echo>(), now_s());
        ++pongs;
        return;
    case MessageKind::command: {
        auto const bytes = in.rest();
        commands.emplace_back(bytes.begin(), bytes.end());
        return;
    }
    case MessageKind::arrived: {
        from.arrival = in.get<Arrival>();
        Echo const echo = in.get<Echo>();
        if (echo.sent_s > 0) from.clock.add(echo, now_s());
        from.note = in.text();
        return swap_of(message.from, in);
    }
    case MessageKind::go:
        gone = in.get<std::uint64_t>();
        last_go = {in.get<double>(), now_s(), 0};
        return;
    case MessageKind::alive:
        return;
    case MessageKind::want:
        ++wants;
        return;
    case MessageKind::data: {
        auto const bytes = in.rest();
        from.data.emplace_back(bytes.begin(), bytes.end());
        return;
    }
    case MessageKind::message: {
        auto const bytes = in.rest();
        heard.push_back({message.from, {bytes.begin(), bytes.end()}});
        return;
    }
    case MessageKind::lost: {
        peers.at(std::size_t(in.get<std::int32_t>())).lost = true;
        news.push_back(in.text() + "; the others go on");
        return;
    }
    case MessageKind::stop: {
        send(message.from, goodbye());
        int const to[] = {message.from};
        messenger->flush(to, 0.5);
        stop(in.text());
    }
    case MessageKind::leaves:
        return lose(message.from, "ended early: " + in.text());
    case MessageKind::end:
        is_ended = true;
        return;
    case MessageKind::goodbye:
        from.said_goodbye = true;
        swap_of(message.from, in);
        from.farewell = in.text();
        return;
    }
    throw std::runtime_error(name(message.from) + " sent a message of unknown kind");
}

void Cluster::State::tell_swap(Writer& message)
{
    message.put(std::uint8_t(swap.known)).put(swap.frame).put(swap.time_s);
    swap.known = false;
}

Writer Cluster::State::goodbye()
{
    Writer out(MessageKind::goodbye);
    tell_swap(out);
    out.put(farewell ? farewell() : std::string());
    return out;
}

void Cluster::State::swap_of(int from, Reader& in)
{
    bool const known = in.get<std::uint8_t>() != 0;
    auto const frame = in.get<std::uint64_t>();
    double const time = in.get<double>();
    auto const clock = peers[std::size_t(from)].clock.estimate();
    if (known && clock) swaps.add(frame, time - clock->ahead_s, clock->error_s);
}

void Cluster::State::note_order(std::span<std::uint8_t const> bytes)
{
    auto const add = [this](std::uint64_t word) {
        orders_check = gi::mix_bits(orders_check ^ (word + 0x9e3779b97f4a7c15ULL));
    };
    add(bytes.size());
    for (std::size_t i = 0; i < bytes.size(); i += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
        add(word);
    }
}

} // namespace viewer
