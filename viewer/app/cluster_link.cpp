#include "viewer/app/cluster_link.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <tuple>
#include <type_traits>

namespace viewer {

namespace {

constexpr std::chrono::seconds kLongestDrawing{1};

static_assert(std::is_trivially_copyable_v<FrameWork>);
std::string to_bytes(FrameWork const& work) { return {reinterpret_cast<char const*>(&work), sizeof work}; }

FrameWork work_from(std::string const& bytes)
{
    FrameWork work;
    if (bytes.size() != sizeof work) throw std::runtime_error("a rank's note on its frame has the wrong length");
    std::memcpy(&work, bytes.data(), sizeof work);
    return work;
}

} // namespace

template <class F>
auto ClusterLink::guarded(F const& call)
{
    alive_.reset();
    try {
        for (std::string const& line : cluster_->take_news()) std::fputs(("lost: " + line + "\n").c_str(), stderr);
        if constexpr (std::is_void_v<decltype(call())>) {
            call();
            alive_ = std::make_unique<KeepAlive>(*cluster_);
        } else {
            auto result = call();
            alive_ = std::make_unique<KeepAlive>(*cluster_);
            return result;
        }
    } catch (RankLoss const& e) {
        failure_ = e.what();
        ends_ = cluster_->ends();
        throw;
    }
}

void ClusterLink::begin()
{
    cluster_ = std::make_unique<Cluster>(identity_, settings_);
    cluster_->set_farewell(farewell_);
}

void ClusterLink::end()
{
    guarded([&] {
        report_swaps();
        cluster_->finish();
    });
    alive_.reset();
    skew_ = cluster_->swap_skew();
    ends_ = cluster_->ends();
    cluster_.reset();
}

bool ClusterLink::leads() const { return cluster_->leads(); }

void ClusterLink::report_swaps()
{
    std::vector<std::pair<std::uint64_t, double>> now;
    {
        std::lock_guard const lock(mutex_);
        now.swap(swaps_);
    }
    for (auto const& [frame, time_s] : now) cluster_->report_swap(frame, time_s);
}

void ClusterLink::send(FrameCommand const& command)
{
    guarded([&] {
        report_swaps();
        cluster_->send(command);
    });
}

std::optional<FrameCommand> ClusterLink::receive()
{
    return guarded([&] {
        report_swaps();
        return cluster_->receive();
    });
}

void ClusterLink::check()
{
    guarded([] {});
}

FrameWork ClusterLink::wait_for_all(FrameCommand const& command, FrameWork const& own)
{
    {
        // The window may be hidden or its loop about to end, so this wait has a time limit.
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kLongestDrawing, [&] { return drawn_ > command.frame; });
    }
    std::vector<std::string> const others =
        guarded([&] { return cluster_->wait(command.frame, 0, to_bytes(own)); });
    {
        std::lock_guard const lock(mutex_);
        released_ = command.frame + 1;
    }
    changed_.notify_all();
    FrameWork slowest = own;
    for (std::string const& bytes : others) {
        FrameWork const other = work_from(bytes);
        if (other.seconds > slowest.seconds) {
            slowest.seconds = other.seconds;
            slowest.surfaces_s = other.surfaces_s;
        }
        slowest.moved |= other.moved;
        gi::DynamicUpdate const &a = other.dynamic_update, &b = slowest.dynamic_update;
        if (std::tie(a.seconds, a.stored) > std::tie(b.seconds, b.stored)) slowest.dynamic_update = a;
    }
    return slowest;
}

void ClusterLink::drawn(std::uint64_t frame)
{
    std::unique_lock lock(mutex_);
    drawn_ = frame + 1;
    changed_.notify_all();
    changed_.wait_for(lock, kLongestDrawing, [&] { return released_ > frame; });
}

void ClusterLink::swapped(std::uint64_t frame, double steady_s)
{
    std::lock_guard const lock(mutex_);
    swaps_.emplace_back(frame, steady_s);
}

} // namespace viewer
