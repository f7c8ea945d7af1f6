#include "ar/capture/session_writer.h"

#include "gi/core/durable_file.h"
#include "gi/core/error.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace ar {
namespace {

int make_file(std::filesystem::path const& path)
{
    int const file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0)
        throw gi::InputError("cannot make '" + path.string() + "'", std::strerror(errno),
                             "choose a folder that can be written");
    return file;
}

/// Returns 0 or the error code.
int write_all(int file, std::uint8_t const* bytes, std::size_t n)
{
    for (std::size_t done = 0; done < n;) {
        ssize_t const now = ::write(file, bytes + done, n - done);
        if (now < 0 && errno == EINTR) continue;
        if (now <= 0) return now == 0 ? ENOSPC : errno;
        done += std::size_t(now);
    }
    return 0;
}

void check_frame(Frame const& f)
{
    auto const refuse = [&](std::string const& why) {
        throw gi::InputError(fmt::format("frame {} cannot be recorded", f.sequence), why,
                             "pass it as the source delivered it");
    };
    Exposure const& e = f.exposure;
    for (double const v : {f.captured_s, f.arrived_s, e.time_s, e.gain, e.red_gain, e.blue_gain})
        if (!std::isfinite(v)) refuse("one of its times or gains is not finite");
    if (f.size_px.x < 1 || f.size_px.y < 1 || f.size_px.x > 65536 || f.size_px.y > 65536) refuse("it has no size");
    auto const is = [&](int plane, int rows, int cols, int type) {
        cv::Mat const& m = f.planes[std::size_t(plane)];
        return m.rows == rows && m.cols == cols && m.type() == type;
    };
    int const x = f.size_px.x, y = f.size_px.y;
    bool good = false;
    switch (f.format) {
    case PixelFormat::rgb8:
    case PixelFormat::bgr8:
        good = is(0, y, x, CV_8UC3);
        break;
    case PixelFormat::gray8:
        good = is(0, y, x, CV_8UC1);
        break;
    case PixelFormat::nv12:
        good = x % 2 == 0 && y % 2 == 0 && is(0, y, x, CV_8UC1) && is(1, y / 2, x / 2, CV_8UC2);
        break;
    case PixelFormat::yuyv:
        good = x % 2 == 0 && is(0, y, x, CV_8UC2);
        break;
    case PixelFormat::mjpeg:
        good = f.planes[0].rows == 1 && f.planes[0].cols > 0 && f.planes[0].type() == CV_8UC1;
        break;
    case PixelFormat::rgb16:
        good = is(0, y, x, CV_16UC3);
        break;
    case PixelFormat::rgb_linear:
        good = is(0, y, x, CV_32FC3);
        break;
    }
    if (!good) refuse("its planes are not those of " + name_of(f.format));
}

void pack(Frame const& f, std::vector<std::uint8_t>& bytes)
{
    std::size_t all = 0;
    for (cv::Mat const& m : f.planes) all += m.total() * m.elemSize();
    bytes.resize(all);
    std::uint8_t* to = bytes.data();
    for (cv::Mat const& m : f.planes) {
        std::size_t const row = std::size_t(m.cols) * m.elemSize();
        if (m.empty()) continue;
        if (m.isContinuous()) {
            std::memcpy(to, m.data, row * std::size_t(m.rows));
            to += row * std::size_t(m.rows);
        } else {
            for (int y = 0; y < m.rows; ++y, to += row) std::memcpy(to, m.ptr(y), row);
        }
    }
}

} // namespace

SessionWriter::SessionWriter(std::filesystem::path const& folder, SessionHeader header, std::size_t most_waiting)
    : folder_(folder), header_(std::move(header)), most_waiting_(most_waiting)
{
    std::error_code error;
    if (!std::filesystem::create_directory(folder, error))
        throw gi::InputError("cannot make the folder '" + folder.string() + "'",
                             error ? error.message() : "it exists, and recordings are never overwritten",
                             error ? "choose a folder that can be written"
                                   : "choose another name, or move it away");
    header_.finished.reset();
    if (header_.created.empty()) header_.created = parse_session_header(to_json(header_), folder.string()).created;
    write_header();
    frames_file_ = make_file(folder / kFramesFile);
    try {
        index_file_ = make_file(folder / kIndexFile);
    } catch (...) {
        ::close(frames_file_);
        throw;
    }
    writer_ = std::thread([this] { write_waiting(); });
}

SessionWriter::~SessionWriter()
{
    try {
        finish();
    } catch (gi::InputError const&) { // the recording stays readable, as one that was cut off
    }
}

void SessionWriter::write_header() { gi::write_durably(folder_ / kSessionFile, to_json(header_)); }

bool SessionWriter::append(Frame const& frame)
{
    check_frame(frame);
    Waiting w;
    w.entry.frame = frame;
    w.entry.frame.planes = {};
    w.entry.frame.owner.reset();
    {
        std::size_t bytes = 0;
        for (cv::Mat const& m : frame.planes) bytes += m.total() * m.elemSize();
        std::lock_guard const lock(mutex_);
        if (closing_ || !failure_.empty() || waiting_bytes_ + bytes > most_waiting_) {
            ++lost_;
            return false;
        }
    }
    w.bytes = spare();
    pack(frame, w.bytes);
    return enqueue(std::move(w));
}

bool SessionWriter::append(Controls const& controls)
{
    Waiting w;
    w.entry.controls = controls;
    return enqueue(std::move(w));
}

std::vector<std::uint8_t> SessionWriter::spare()
{
    std::lock_guard const lock(mutex_);
    if (spare_.empty()) return {};
    std::vector<std::uint8_t> bytes = std::move(spare_.back());
    spare_.pop_back();
    return bytes;
}

bool SessionWriter::enqueue(Waiting waiting)
{
    std::lock_guard const lock(mutex_);
    if (closing_ || !failure_.empty()) {
        ++lost_;
        return false;
    }
    waiting_bytes_ += waiting.bytes.size();
    waiting_.push_back(std::move(waiting));
    wake_.notify_one();
    return true;
}

void SessionWriter::write_waiting()
{
    auto synced = std::chrono::steady_clock::now();
    for (;;) {
        std::optional<Waiting> w;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return closing_ || !waiting_.empty(); });
            if (waiting_.empty()) return;
            w = std::move(waiting_.front());
            waiting_.pop_front();
        }
        std::size_t const bytes = w->bytes.size();
        write(*w);
        if (auto const now = std::chrono::steady_clock::now(); now - synced > std::chrono::seconds(1)) {
            if (::fdatasync(frames_file_) != 0 || ::fdatasync(index_file_) != 0) fail(std::strerror(errno));
            synced = std::chrono::steady_clock::now();
        }
        std::lock_guard const lock(mutex_);
        waiting_bytes_ -= bytes;
        if (spare_.size() < 8 && bytes > 0) spare_.push_back(std::move(w->bytes));
    }
}

void SessionWriter::write(Waiting& w)
{
    if (!failure().empty()) {
        ++lost_;
        return;
    }
    w.entry.at = frames_bytes_;
    w.entry.bytes = w.bytes.size();
    w.entry.sum = checksum(w.bytes);
    std::string const line = index_line(w.entry) + "\n";
    int error = write_all(frames_file_, w.bytes.data(), w.bytes.size());
    if (error == 0)
        error = write_all(index_file_, reinterpret_cast<std::uint8_t const*>(line.data()), line.size());
    if (error != 0) {
        ++lost_;
        fail(std::strerror(error));
        // Remove the incomplete part; if that fails, too, readers skip it.
        if (::ftruncate(frames_file_, off_t(frames_bytes_)) != 0 ||
            ::ftruncate(index_file_, off_t(index_bytes_)) != 0)
            fail(std::strerror(errno));
        return;
    }
    frames_bytes_ += w.bytes.size();
    index_bytes_ += line.size();
    if (!w.entry.controls) ++written_;
}

void SessionWriter::fail(std::string const& why)
{
    std::lock_guard const lock(mutex_);
    if (failure_.empty()) failure_ = why;
}

std::string SessionWriter::failure() const
{
    std::lock_guard const lock(mutex_);
    return failure_;
}

void SessionWriter::finish()
{
    {
        std::lock_guard const lock(mutex_);
        if (closing_) return;
        closing_ = true;
        wake_.notify_one();
    }
    writer_.join();
    for (int const file : {frames_file_, index_file_}) {
        if (::fdatasync(file) != 0) fail(std::strerror(errno));
        if (::close(file) != 0) fail(std::strerror(errno));
    }
    if (!failure().empty()) return; // it was cut off
    header_.finished = {written_, lost_};
    write_header();
}

} // namespace ar
