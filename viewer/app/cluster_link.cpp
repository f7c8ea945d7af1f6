#include "viewer/app/cluster_link.h"

#include "viewer/app/light_wire.h"
#include "viewer/protocol/cluster/wire.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <tuple>
#include <type_traits>

namespace viewer {

namespace {

constexpr double kLongestDrawing_s = 1; // the window may be hidden, or its loop about to end
constexpr std::chrono::duration<double> kLongestDrawing{kLongestDrawing_s};

enum class Order : std::uint8_t { render, show };
enum class Said : std::uint8_t { light, done };

static_assert(std::is_trivially_copyable_v<FrameWork>);

/// As a rank tells the leader.
std::string note_of(ShownState const& own) { return {own.draws_surfaces ? '1' : '0', own.fades ? '1' : '0'}; }

ShownState joined(ShownState const& all, std::string const& note)
{
    bool const is_note = note.size() == 2;
    return {all.draws_surfaces && is_note && note[0] == '1', all.fades || (is_note && note[1] == '1')};
}

} // namespace

ClusterLink::~ClusterLink()
{
    {
        std::lock_guard const lock(mutex_);
        leaves_ = true;
    }
    work_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void ClusterLink::begin()
{
    thread_ = std::thread([this] { run(); });
    std::unique_lock lock(mutex_);
    wait_until(lock, [&] { return has_begun_; });
}

void ClusterLink::end()
{
    {
        std::lock_guard const lock(mutex_);
        wants_end_ = true;
    }
    work_.notify_all();
    thread_.join();
    if (error_) std::rethrow_exception(error_);
}

void ClusterLink::run()
{
    std::exception_ptr error;
    try {
        Cluster cluster(identity_, settings_);
        cluster.set_farewell(farewell_);
        {
            std::lock_guard const lock(mutex_);
            rank_ = cluster.rank();
            leads_ = cluster.leads();
            is_lost_.resize(std::size_t(cluster.size()));
            has_begun_ = true;
        }
        changed_.notify_all();
        try {
            if (talk(cluster)) cluster.finish();
        } catch (RankLoss const& e) {
            failure_ = e.what();
            error = std::current_exception();
        }
        skew_ = cluster.swap_skew();
        ends_ = cluster.ends();
    } catch (...) {
        error = std::current_exception();
    }
    std::function<void()> wake;
    {
        std::lock_guard const lock(mutex_);
        error_ = error;
        is_over_ = is_ended_ = true;
        wake = wake_;
    }
    changed_.notify_all();
    if (wake) wake();
}

/// Until the leader ends. False: until this rank leaves before.
bool ClusterLink::talk(Cluster& cluster)
{
    using std::chrono::microseconds;
    constexpr microseconds kSwap{50}, kSoon{250}, kQuiet{1000};
    constexpr double kQuietAfter_s = 0.1;
    double last_s = Cluster::now_s();
    while (true) {
        for (std::string const& line : cluster.take_news()) std::fputs(("lost: " + line + "\n").c_str(), stderr);
        bool const did = step(cluster);
        std::unique_lock lock(mutex_);
        if (leaves_) return false;
        if (leads_ ? wants_end_ && orders_.empty() : is_ended_) return true;
        double const now_s = Cluster::now_s();
        if (did) {
            last_s = now_s;
            lock.unlock();
            changed_.notify_all();
            continue;
        }
        bool const swaps = showing_.drawn == showing_.number && showing_.released != showing_.number;
        work_.wait_for(lock, swaps ? kSwap : now_s - last_s < kQuietAfter_s ? kSoon : kQuiet);
    }
}

/// True if something came or went.
bool ClusterLink::step(Cluster& cluster)
{
    cluster.watch([this](int r) {
        std::lock_guard const lock(mutex_);
        return awaits(r);
    });
    std::lock_guard const lock(mutex_);
    bool did = false;
    for (std::size_t r = 0; r < is_lost_.size(); ++r)
        if (is_lost_[r] == 0 && cluster.lost(int(r))) is_lost_[r] = did = true;
    for (auto const& [number, time_s] : std::exchange(swaps_, {})) cluster.report_swap(number, time_s);
    did |= send_all(cluster);
    did |= swap_together(cluster); // before the next moment, which may have come with the leave to swap
    did |= take_orders(cluster);
    did |= take_messages(cluster);
    return did;
}

/// Why the leader waits for a rank, or a follower for the leader.
std::string ClusterLink::awaits(int rank) const
{
    if (!leads_) return rank == 0 ? "while waiting for a frame command" : "";
    auto const lacks = [&](std::optional<std::uint64_t> frame, auto const& of) {
        auto const told = frame ? told_.find(*frame) : told_.end();
        return frame && (told == told_.end() || !(told->second.*of).contains(rank));
    };
    if (lacks(light_of_, &Told::light)) return fmt::format("while waiting for its light of frame {}", *light_of_);
    if (lacks(waits_for_, &Told::work)) return fmt::format("before frame {} was finished", *waits_for_);
    bool const swaps = showing_.drawn == showing_.number && showing_.released != showing_.number;
    return swaps ? fmt::format("before swap {}", showing_.number) : "";
}

bool ClusterLink::send_all(Cluster& cluster)
{
    bool const any = !orders_.empty() || !messages_.empty();
    for (; !orders_.empty(); orders_.pop_front()) {
        cluster.send(orders_.front());
        if (Order(orders_.front()[0]) != Order::show) continue;
        showing_.state = cluster.orders_check();
        showing_.is_announced = true;
    }
    for (; !messages_.empty(); messages_.pop_front()) {
        auto const& [to, bytes] = messages_.front();
        for (int r = 0; r < int(is_lost_.size()); ++r)
            if (r != rank_ && (to < 0 || r == to)) cluster.tell(r, bytes);
    }
    return any;
}

bool ClusterLink::take_orders(Cluster& cluster)
{
    bool any = false;
    for (; auto const bytes = cluster.take_order(); any = true) {
        Reader in(*bytes);
        if (in.get<Order>() == Order::render) {
            commands_.push_back(command_from_bytes(in.rest()));
            continue;
        }
        ShownMoment next;
        next.number = showing_.number = in.get<std::uint64_t>();
        next.surfaces_scale = in.get<double>();
        next.moment = command_from_bytes(in.rest());
        next_shown_ = std::move(next);
        showing_.state = cluster.orders_check();
        showing_.is_announced = false;
        showing_.since_s = Cluster::now_s();
        if (wake_) wake_();
    }
    is_ended_ = !leads_ && cluster.ended();
    return any || is_ended_;
}

bool ClusterLink::take_messages(Cluster& cluster)
{
    std::vector<Cluster::Heard> const heard = cluster.heard();
    for (auto const& [from, message] : heard) {
        Reader in(message);
        auto const what = in.get<Said>();
        Told& told = told_[in.get<std::uint64_t>()];
        auto const rest = in.rest();
        if (what == Said::light)
            told.light[from] = {rest.begin(), rest.end()};
        else
            told.work[from] = Reader(rest).get<FrameWork>();
    }
    return !heard.empty();
}

bool ClusterLink::swap_together(Cluster& cluster)
{
    Showing& s = showing_;
    if (s.released == s.number) return false;
    bool const is_drawn = s.drawn == s.number;
    if (leads_) {
        if (!is_drawn || !s.is_announced || !cluster.may_swap(s.number)) return false;
        std::vector<std::string> const notes = cluster.release(s.number, s.state);
        all_shown_ = s.own;
        for (std::string const& n : notes) all_shown_ = joined(all_shown_, n);
        s.released = s.number;
        return true;
    }
    if (!s.is_announced) {
        if (!is_drawn && Cluster::now_s() - s.since_s < kLongestDrawing_s) return false;
        // A picture that is not drawn in time may never be: it is not waited for.
        cluster.arrive(s.number, s.state, note_of(is_drawn ? s.own : ShownState{s.own.draws_surfaces, false}));
        return s.is_announced = true;
    }
    if (!cluster.may_swap(s.number)) return false;
    s.released = s.number;
    return true;
}

/// Throws what ended the link early.
void ClusterLink::wait_until(std::unique_lock<std::mutex>& lock, std::function<bool()> const& condition)
{
    work_.notify_all();
    changed_.wait(lock, [&] { return is_over_ || condition(); });
    if (error_) std::rethrow_exception(error_);
}

bool ClusterLink::others_all(std::function<bool(int)> const& condition) const
{
    for (int r = 0; r < int(is_lost_.size()); ++r)
        if (r != rank_ && is_lost_[std::size_t(r)] == 0 && !condition(r)) return false;
    return true;
}

void ClusterLink::send(FrameCommand const& command)
{
    Bytes order = std::move(Writer().put(Order::render).append(to_bytes(command))).take();
    std::unique_lock lock(mutex_);
    orders_.push_back(std::move(order));
    wait_until(lock, [] { return true; });
}

std::optional<FrameCommand> ClusterLink::receive()
{
    std::unique_lock lock(mutex_);
    wait_until(lock, [&] { return !commands_.empty() || is_ended_; });
    if (commands_.empty()) return {};
    FrameCommand const next = std::move(commands_.front());
    commands_.pop_front();
    return next;
}

void ClusterLink::check()
{
    std::unique_lock lock(mutex_);
    wait_until(lock, [] { return true; });
}

FrameLight ClusterLink::exchange(FrameCommand const& command, FrameLight own)
{
    if (!leads_) own.cells = nullptr;
    Bytes message = std::move(Writer().put(Said::light).put(command.frame).append(to_bytes(own))).take();
    std::map<int, Bytes> others;
    {
        std::unique_lock lock(mutex_);
        messages_.emplace_back(-1, std::move(message));
        light_of_ = command.frame;
        Told& told = told_[command.frame];
        wait_until(lock, [&] { return others_all([&](int r) { return told.light.contains(r); }); });
        light_of_.reset();
        others.swap(told.light);
        for (auto const& [r, bytes] : others) told.light[r]; // is known
    }
    for (auto const& [r, bytes] : others) add_light(bytes, command, own);
    return own;
}

FrameWork ClusterLink::wait_for_all(FrameCommand const& command, FrameWork const& own)
{
    std::unique_lock lock(mutex_);
    FrameWork slowest = own;
    if (leads_) {
        waits_for_ = command.frame;
        Told const& told = told_[command.frame];
        wait_until(lock, [&] { return others_all([&](int r) { return told.work.contains(r); }); });
        waits_for_.reset();
        for (auto const& [r, other] : told.work) {
            if (other.seconds > slowest.seconds) {
                slowest.seconds = other.seconds;
                slowest.surfaces_s = other.surfaces_s;
            }
            slowest.moved |= other.moved;
            gi::DynamicUpdate const &a = other.dynamic_update, &b = slowest.dynamic_update;
            if (std::tie(a.seconds, a.stored) > std::tie(b.seconds, b.stored)) slowest.dynamic_update = a;
        }
    } else {
        messages_.emplace_back(0, std::move(Writer().put(Said::done).put(command.frame).put(own)).take());
        work_.notify_all();
    }
    told_.erase(told_.begin(), told_.upper_bound(command.frame));
    return slowest;
}

std::uint64_t ClusterLink::show(ShownMoment moment)
{
    Bytes const command = to_bytes(moment.moment);
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_over_ || showing_.released == showing_.number; });
    ++showing_.number;
    showing_.is_announced = false;
    orders_.push_back(
        std::move(Writer().put(Order::show).put(showing_.number).put(moment.surfaces_scale).append(command))
            .take());
    work_.notify_all();
    return showing_.number;
}

std::optional<ShownMoment> ClusterLink::next_shown()
{
    std::lock_guard const lock(mutex_);
    return std::exchange(next_shown_, {});
}

void ClusterLink::wake_by(std::function<void()> wake)
{
    std::lock_guard const lock(mutex_);
    wake_ = std::move(wake);
}

void ClusterLink::drawn(std::uint64_t number, ShownState own)
{
    std::unique_lock lock(mutex_);
    showing_.drawn = number;
    showing_.own = own;
    work_.notify_all();
    changed_.wait_for(lock, kLongestDrawing, [&] { return is_over_ || showing_.released >= number; });
}

void ClusterLink::swapped(std::uint64_t number, double steady_s)
{
    std::lock_guard const lock(mutex_);
    swaps_.emplace_back(number, steady_s);
}

ShownState ClusterLink::shown_state() const
{
    std::lock_guard const lock(mutex_);
    return all_shown_;
}

} // namespace viewer
