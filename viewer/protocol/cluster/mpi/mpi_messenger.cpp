// The module that links MPI.

#include "viewer/protocol/cluster/messenger.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <mpi.h>
#include <thread>

namespace viewer {
namespace {

constexpr int kTag = 5;

struct Sending {
    MPI_Request request = MPI_REQUEST_NULL;
    std::vector<std::uint8_t> bytes;
};

struct Receiving {
    MPI_Request request = MPI_REQUEST_NULL;
    Message message;
};

bool done(MPI_Request& request)
{
    int flag = 0;
    return MPI_Test(&request, &flag, MPI_STATUS_IGNORE) == MPI_SUCCESS && flag != 0;
}

struct Transfers {
    std::vector<std::deque<Sending>> sending;     ///< per rank
    std::vector<std::deque<Receiving>> receiving; ///< per rank
};

class MpiMessenger : public Messenger {
public:
    MpiMessenger() : transfers_(std::make_unique<Transfers>())
    {
        MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); // survive the loss of a rank
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
        transfers_->sending.resize(std::size_t(size_));
        transfers_->receiving.resize(std::size_t(size_));
    }
    // If MPI was not finalized, leak the buffers, because MPI may still read them.
    ~MpiMessenger() override
    {
        int finalized = 0;
        MPI_Finalized(&finalized);
        if (finalized == 0) static_cast<void>(transfers_.release());
    }
    int rank() const override { return rank_; }
    int size() const override { return size_; }
    void send(int to, std::vector<std::uint8_t> bytes) override;
    std::vector<Message> poll() override;
    bool sent_all(int to) override;
    void flush(std::span<int const> ranks, double at_most_s) override;
    void finalize() override { MPI_Finalize(); }

private:
    int rank_ = 0, size_ = 1;
    std::unique_ptr<Transfers> transfers_;
};

void MpiMessenger::send(int to, std::vector<std::uint8_t> bytes)
{
    auto& queue = transfers_->sending[std::size_t(to)];
    queue.push_back({MPI_REQUEST_NULL, std::move(bytes)});
    Sending& s = queue.back();
    if (MPI_Isend(s.bytes.data(), int(s.bytes.size()), MPI_BYTE, to, kTag, MPI_COMM_WORLD, &s.request) !=
        MPI_SUCCESS)
        queue.pop_back(); // a dead rank is detected elsewhere
}

std::vector<Message> MpiMessenger::poll()
{
    while (true) {
        int there = 0;
        MPI_Message handle;
        MPI_Status status;
        if (MPI_Improbe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &there, &handle, &status) != MPI_SUCCESS ||
            there == 0)
            break;
        int size = 0;
        MPI_Get_count(&status, MPI_BYTE, &size);
        auto& queue = transfers_->receiving[std::size_t(status.MPI_SOURCE)];
        queue.push_back({MPI_REQUEST_NULL, {status.MPI_SOURCE, std::vector<std::uint8_t>(std::size_t(size))}});
        Receiving& r = queue.back();
        MPI_Imrecv(r.message.bytes.data(), size, MPI_BYTE, &handle, &r.request);
    }
    std::vector<Message> arrived;
    for (auto& queue : transfers_->receiving)
        while (!queue.empty() && done(queue.front().request)) {
            arrived.push_back(std::move(queue.front().message));
            queue.pop_front();
        }
    for (int r = 0; r < size_; ++r) sent_all(r);
    return arrived;
}

bool MpiMessenger::sent_all(int to)
{
    auto& queue = transfers_->sending[std::size_t(to)];
    while (!queue.empty() && done(queue.front().request)) queue.pop_front();
    return queue.empty();
}

void MpiMessenger::flush(std::span<int const> ranks, double at_most_s)
{
    auto const end = std::chrono::steady_clock::now() + std::chrono::duration<double>(at_most_s);
    auto const all_sent = [&] {
        return std::all_of(ranks.begin(), ranks.end(), [this](int r) { return sent_all(r); });
    };
    while (!all_sent() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

} // namespace
} // namespace viewer

viewer::Messenger* lightwell_messenger()
{
    // Otherwise hwloc queries every X server of this machine for its screens, and a server that ends meanwhile
    // terminates this process.
    setenv("HWLOC_COMPONENTS", "-gl", 0);
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    return provided < MPI_THREAD_SERIALIZED ? nullptr : new viewer::MpiMessenger;
}
