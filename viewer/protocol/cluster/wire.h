#pragma once
// Messages between the ranks of a cluster. All ranks are little-endian machines that run the same program version,
// which their first message states.

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace viewer {

enum class MessageKind : std::uint8_t {
    hello,   ///< follower: its identity
    refused, ///< leader: the follower's identity differs; the reason
    started, ///< leader: all ranks have started; their names
    ping,    ///< leader: its time, s
    pong,    ///< follower: Echo
    command, ///< leader: an order
    arrived, ///< follower: ready to swap; with a note
    go,      ///< leader: all ranks are ready to swap
    alive,   ///< any rank: sign of life while it waits or works
    want,    ///< leader: requests the next data
    data,    ///< follower: the requested data
    message, ///< any rank: Cluster::tell
    lost,    ///< leader: a rank is lost, the others continue
    stop,    ///< leader: a rank is lost, all stop
    leaves,  ///< any rank: it ends early; the reason
    end,     ///< leader: the session ends
    goodbye  ///< follower: confirms the end
};

/// Times of a message and its answer, on the steady clocks of leader and follower, s.
struct Echo {
    double sent_s = 0;     ///< leader
    double received_s = 0; ///< follower
    double answered_s = 0; ///< follower
};

class Writer {
public:
    Writer() = default;
    explicit Writer(MessageKind kind) { put(kind); }
    template <class T>
    Writer& put(T const& value)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        auto const* at = reinterpret_cast<std::uint8_t const*>(&value);
        bytes_.insert(bytes_.end(), at, at + sizeof value);
        return *this;
    }
    Writer& put(std::string const& text)
    {
        put(std::uint32_t(text.size()));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
        return *this;
    }
    Writer& append(std::span<std::uint8_t const> bytes)
    {
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        return *this;
    }
    std::vector<std::uint8_t> take() { return std::move(bytes_); }
    std::vector<std::uint8_t> const& bytes() const { return bytes_; }

private:
    std::vector<std::uint8_t> bytes_;
};

/// Throws std::runtime_error if a message is too short.
class Reader {
public:
    explicit Reader(std::span<std::uint8_t const> bytes) : bytes_(bytes) {}
    template <class T>
    T get()
    {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(&value, next(sizeof value).data(), sizeof value);
        return value;
    }
    std::string text()
    {
        auto const part = next(get<std::uint32_t>());
        return {part.begin(), part.end()};
    }
    std::span<std::uint8_t const> rest() { return next(bytes_.size()); }
    std::span<std::uint8_t const> part(std::size_t bytes) { return next(bytes); }

private:
    std::span<std::uint8_t const> next(std::size_t n)
    {
        if (n > bytes_.size()) throw std::runtime_error("a message of another rank is cut short");
        auto const part = bytes_.first(n);
        bytes_ = bytes_.subspan(n);
        return part;
    }
    std::span<std::uint8_t const> bytes_;
};

} // namespace viewer
