#include "gi/core/xxhash.h"

#include <bit>
#include <cstring>

namespace gi {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t k1 = 0x9E3779B185EBCA87, k2 = 0xC2B2AE3D27D4EB4F, k3 = 0x165667B19E3779F9,
                        k4 = 0x85EBCA77C2B2AE63, k5 = 0x27D4EB2F165667C5;

template <class T>
T read(std::byte const* at)
{
    T v;
    std::memcpy(&v, at, sizeof v);
    return v;
}

std::uint64_t round(std::uint64_t sum, std::uint64_t v) { return std::rotl(sum + v * k2, 31) * k1; }
std::uint64_t merge(std::uint64_t hash, std::uint64_t sum) { return (hash ^ round(0, sum)) * k1 + k4; }

} // namespace

std::uint64_t xxh64(std::span<std::byte const> bytes, std::uint64_t seed)
{
    std::byte const* at = bytes.data();
    std::byte const* const end = at + bytes.size();
    std::uint64_t hash = seed + k5;
    if (bytes.size() >= 32) {
        std::uint64_t a = seed + k1 + k2, b = seed + k2, c = seed, d = seed - k1;
        for (; end - at >= 32; at += 32) {
            a = round(a, read<std::uint64_t>(at));
            b = round(b, read<std::uint64_t>(at + 8));
            c = round(c, read<std::uint64_t>(at + 16));
            d = round(d, read<std::uint64_t>(at + 24));
        }
        hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
        hash = merge(merge(merge(merge(hash, a), b), c), d);
    }
    hash += bytes.size();
    for (; end - at >= 8; at += 8) hash = std::rotl(hash ^ round(0, read<std::uint64_t>(at)), 27) * k1 + k4;
    if (end - at >= 4) {
        hash = std::rotl(hash ^ read<std::uint32_t>(at) * k1, 23) * k2 + k3;
        at += 4;
    }
    for (; at < end; ++at) hash = std::rotl(hash ^ std::uint64_t(*at) * k5, 11) * k1;
    hash = (hash ^ hash >> 33) * k2;
    hash = (hash ^ hash >> 29) * k3;
    return hash ^ hash >> 32;
}

} // namespace gi
