#include "viewer/app/present_thread.h"

namespace viewer {

PresentThread::PresentThread() : thread_([this] { run(); }) {}

PresentThread::~PresentThread()
{
    {
        std::lock_guard const lock(mutex_);
        ends_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

bool PresentThread::busy() const
{
    std::lock_guard const lock(mutex_);
    return busy_;
}

void PresentThread::start(std::function<void()> work, std::function<void()> done)
{
    {
        std::lock_guard const lock(mutex_);
        work_ = std::move(work);
        done_ = std::move(done);
        busy_ = true;
    }
    wake_.notify_all();
}

void PresentThread::run()
{
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [&] { return busy_ || ends_; });
        if (!busy_) return;
        std::function<void()> const work = std::move(work_), done = std::move(done_);
        lock.unlock();
        work();
        lock.lock();
        busy_ = false;
        lock.unlock();
        done();
        lock.lock();
    }
}

} // namespace viewer
