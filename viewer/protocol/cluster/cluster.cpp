#include "viewer/protocol/cluster/cluster.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/rng.h"
#include "viewer/protocol/cluster/cluster_state.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

namespace viewer {

OnRankLoss parse_on_rank_loss(std::string const& text)
{
    if (text == "stop") return OnRankLoss::stop;
    if (text == "continue") return OnRankLoss::go_on;
    throw gi::InputError("--on-rank-loss " + text, "there is no such choice", "choose stop or continue");
}

std::uint64_t file_hash(std::string const& file)
{
    if (!std::filesystem::is_regular_file(file)) return 0;
    std::uint64_t hash = 0;
    for (unsigned char const byte : gi::read_bytes(file)) hash = gi::mix_bits(hash + byte + 1);
    return hash;
}

Cluster::Cluster(ClusterIdentity const& identity, ClusterSettings const& settings)
    : state_(std::make_unique<State>(identity, settings))
{
    state_->start();
}

Cluster::~Cluster()
{
    try {
        leave("see its own message");
    } catch (std::exception const&) {
        // No rank is left to notify.
    }
}

bool Cluster::started_by_mpirun() { return started_with_others(); }
int Cluster::rank() const { return state_->rank; }
int Cluster::size() const { return state_->size; }
std::string Cluster::name(int r) const { return state_->name(r); }
std::vector<std::string> Cluster::take_news() { return std::exchange(state_->news, {}); }

double Cluster::now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void Cluster::check()
{
    if (!alone()) state_->pump();
}

void Cluster::watch(std::function<std::string(int)> const& why)
{
    if (alone()) return;
    State& s = *state_;
    s.pump();
    for (int r : s.other_ranks()) {
        State::Peer& p = s.peers[std::size_t(r)];
        std::string const what_for = s.living(r) ? why(r) : std::string();
        if (what_for.empty())
            p.awaited_s.reset();
        else if (!p.awaited_s)
            p.awaited_s = s.listened_s;
        else
            s.lose_if_silent(r, *p.awaited_s, s.settings.silence_s, what_for);
    }
}

bool Cluster::lost(int r) const { return state_->peers[std::size_t(r)].lost; }

void Cluster::send(std::span<std::uint8_t const> order)
{
    if (alone()) return;
    state_->note_order(order);
    state_->pump();
    state_->send_to_others(Writer(MessageKind::command).append(order));
}

std::optional<std::vector<std::uint8_t>> Cluster::receive()
{
    if (alone()) return {};
    State& s = *state_;
    s.await([&s] { return !s.commands.empty() || s.is_ended; }, [](int who) { return who == 0; },
            s.settings.silence_s, "while waiting for a frame command");
    auto order = take_order();
    if (!order) finish();
    return order;
}

std::optional<std::vector<std::uint8_t>> Cluster::take_order()
{
    State& s = *state_;
    if (s.commands.empty()) return {};
    std::vector<std::uint8_t> order = std::move(s.commands.front());
    s.commands.pop_front();
    s.note_order(order);
    return order;
}

bool Cluster::ended() const { return state_->is_ended && state_->commands.empty(); }
std::uint64_t Cluster::orders_check() const { return state_->orders_check; }

std::vector<std::string> Cluster::wait(std::uint64_t frame, std::uint64_t check, std::string const& note)
{
    if (alone()) return {};
    State& s = *state_;
    std::uint64_t const mine = gi::mix_bits(s.orders_check ^ gi::mix_bits(check));
    if (!leads()) arrive(frame, mine, note);
    s.await([&] { return may_swap(frame); }, [&](int who) { return leads() ? s.is_missing(who) : who == 0; },
            s.settings.silence_s, fmt::format("before the swap of frame {}", frame));
    return leads() ? release(frame, mine) : std::vector<std::string>();
}

void Cluster::arrive(std::uint64_t frame, std::uint64_t state, std::string const& note)
{
    State& s = *state_;
    Writer out(MessageKind::arrived);
    s.last_go.answered_s = now_s();
    out.put(State::Arrival{frame, state}).put(s.last_go).put(note);
    s.tell_swap(out);
    s.send(0, std::move(out));
}

bool Cluster::may_swap(std::uint64_t frame) const
{
    State const& s = *state_;
    if (!leads()) return s.gone == frame;
    auto const others = s.other_ranks();
    return std::none_of(others.begin(), others.end(), [&s](int r) { return s.is_missing(r); });
}

std::vector<std::string> Cluster::release(std::uint64_t frame, std::uint64_t state)
{
    State& s = *state_;
    std::vector<std::string> notes;
    for (int r : s.other_ranks()) {
        auto const arrival = std::exchange(s.peers[std::size_t(r)].arrival, {});
        if (!s.living(r) || !arrival) continue;
        if (arrival->frame != frame)
            s.lose(r, fmt::format("is at frame {}, not {}", arrival->frame, frame));
        else if (arrival->check != state)
            s.lose(r, fmt::format("has another scene or other commands than {} at frame {} (check {:016x}, not "
                                  "{:016x})",
                                  name(0), frame, arrival->check, state));
        else
            notes.push_back(std::move(s.peers[std::size_t(r)].note));
    }
    s.send_to_others(Writer(MessageKind::go).put(frame).put(now_s()));
    return notes;
}

void Cluster::report_swap(std::uint64_t frame, double time_s)
{
    if (alone()) return;
    if (leads())
        state_->swaps.add(frame, time_s, 0);
    else
        state_->swap = {frame, time_s, true};
}

SwapSkew Cluster::swap_skew() const { return state_->swaps.skew(); }

std::pair<double, double> Cluster::clock_ahead_s(int r) const
{
    auto const clock = state_->peers[std::size_t(r)].clock.estimate();
    return clock ? std::pair(clock->ahead_s, clock->error_s) : std::pair(0.0, 0.0);
}

void Cluster::tell(int to, std::span<std::uint8_t const> message)
{
    if (state_->living(to)) state_->send(to, std::move(Writer(MessageKind::message).append(message)));
}

std::vector<Cluster::Heard> Cluster::heard() { return std::exchange(state_->heard, {}); }

void Cluster::give(std::vector<std::uint8_t> bytes)
{
    State& s = *state_;
    s.await([&s] { return s.wants > 0; }, [](int who) { return who == 0; }, s.settings.silence_s,
            "while it took the data of this rank");
    --s.wants;
    s.send(0, std::move(Writer(MessageKind::data).append(bytes)));
    s.await([&s] { return s.messenger->sent_all(0); }, [](int who) { return who == 0; }, s.settings.silence_s,
            "while it took the data of this rank");
}

std::optional<std::vector<std::uint8_t>> Cluster::take(int from)
{
    State& s = *state_;
    State::Peer& p = s.peers[std::size_t(from)];
    if (!s.living(from)) return {};
    s.send(from, Writer(MessageKind::want));
    s.await([&] { return !p.data.empty() || !s.living(from); }, [from](int who) { return who == from; },
            s.settings.silence_s, "while waiting for its part");
    if (p.data.empty()) return {};
    auto bytes = std::move(p.data.front());
    p.data.pop_front();
    return bytes;
}

void Cluster::finish()
{
    State& s = *state_;
    if (alone() || s.over) return;
    auto const others = s.other_ranks();
    if (leads()) {
        s.send_to_others(Writer(MessageKind::end));
        auto const is_missing = [&s](int r) { return s.living(r) && !s.peers[std::size_t(r)].said_goodbye; };
        s.await([&] { return std::none_of(others.begin(), others.end(), is_missing); }, is_missing,
                s.settings.silence_s, "at the end");
        // No rank is lost from here on. The last message says whether all ranks may
        // wait for each other in MPI_Finalize.
        s.send_to_others(Writer(MessageKind::go).put(std::uint64_t(s.others_living())).put(now_s()));
    } else {
        s.await([&s] { return s.is_ended; }, [](int who) { return who == 0; }, s.settings.silence_s, "at the end");
        Writer out = s.goodbye();
        s.gone.reset();
        s.is_leaving = true;
        s.send(0, std::move(out));
        s.await([&s] { return s.gone.has_value() || s.peers[0].lost; }, [](int who) { return who == 0; },
                s.settings.silence_s, "at the end");
    }
    bool const all = leads() ? s.others_living() : s.gone.value_or(0) != 0;
    s.messenger->flush(others, 0.5);
    s.over = true;
    if (all) s.messenger->finalize();
}

void Cluster::set_farewell(std::function<std::string()> farewell) { state_->farewell = std::move(farewell); }

std::vector<RankEnd> Cluster::ends() const
{
    std::vector<RankEnd> all;
    for (int r : state_->other_ranks()) {
        State::Peer const& p = state_->peers[std::size_t(r)];
        all.push_back({r, name(r), p.how_lost, p.farewell});
    }
    return all;
}

void Cluster::leave(std::string const& why)
{
    State& s = *state_;
    if (alone() || s.over) return;
    s.over = true;
    if (!s.broken.empty()) return; // the others know already, or have left
    s.send_to_others(Writer(MessageKind::leaves).put(why));
    std::vector<int> rest;
    for (int r : s.other_ranks())
        if (s.living(r)) rest.push_back(r);
    s.messenger->flush(rest, 0.5);
}

} // namespace viewer
