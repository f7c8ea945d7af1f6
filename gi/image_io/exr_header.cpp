// OpenEXR 3.1.5 trusts the sizes in a header: a 2 GB string in a file of 300 bytes is allocated and filled before
// reading fails, and a value of the wrong size shifts everything after it. So this code checks headers first.
// Layout: openexr.com/en/latest/OpenEXRFileLayout.html.

#include "gi/core/error.h"
#include "gi/image_io/exr.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>

namespace gi {
namespace {

struct FixedSize {
    std::string_view type;
    std::size_t bytes;
};
constexpr std::array kFixedSizes{
    FixedSize{"box2i", 16},
    FixedSize{"box2f", 16},
    FixedSize{"chromaticities", 32},
    FixedSize{"compression", 1},
    FixedSize{"double", 8},
    FixedSize{"envmap", 1},
    FixedSize{"deepImageState", 1},
    FixedSize{"float", 4},
    FixedSize{"int", 4},
    FixedSize{"keycode", 28},
    FixedSize{"lineOrder", 1},
    FixedSize{"m33f", 36},
    FixedSize{"m33d", 72},
    FixedSize{"m44f", 64},
    FixedSize{"m44d", 128},
    FixedSize{"rational", 8},
    FixedSize{"tiledesc", 9},
    FixedSize{"timecode", 8},
    FixedSize{"v2i", 8},
    FixedSize{"v2f", 8},
    FixedSize{"v2d", 16},
    FixedSize{"v3i", 12},
    FixedSize{"v3f", 12},
    FixedSize{"v3d", 24},
};

class HeaderWalk {
public:
    HeaderWalk(std::span<unsigned char const> bytes, std::string const& name) : bytes_(bytes), name_(name) {}

    void check()
    {
        constexpr std::uint32_t kMagic = 20000630, kMultiPart = 0x1000;
        if (number() != kMagic) fail("it does not start like an OpenEXR file");
        bool const multi_part = (number() & kMultiPart) != 0;
        do {
            while (check_attribute()) {
            }
        } while (multi_part && at_ < bytes_.size() && bytes_[at_] != 0);
    }

private:
    [[noreturn]] void fail(std::string const& why) const { throw bad_exr(name_, why); }
    std::size_t left() const { return bytes_.size() - at_; }
    std::uint32_t number()
    {
        if (left() < 4) fail("it ends within its header");
        std::uint32_t value;
        std::memcpy(&value, bytes_.data() + at_, 4);
        at_ += 4;
        return value;
    }
    std::string_view text()
    {
        auto const* const begin = reinterpret_cast<char const*>(bytes_.data()) + at_;
        void const* const end = left() == 0 ? nullptr : std::memchr(begin, 0, left());
        if (end == nullptr) fail("it ends within its header");
        std::string_view const s(begin, std::size_t(static_cast<char const*>(end) - begin));
        at_ += s.size() + 1;
        return s;
    }
    /// @return false at the end of the header
    bool check_attribute()
    {
        std::string_view const attribute = text();
        if (attribute.empty()) return false;
        std::string_view const type = text();
        std::size_t const size = number();
        if (size > left()) fail(fmt::format("its attribute '{}' is longer than the file", attribute));
        std::size_t const end = at_ + size;
        if (!fits(type, size)) fail(fmt::format("its attribute '{}' is not a valid {}", attribute, type));
        at_ = end;
        return true;
    }
    /// True if the value that starts here is exactly `size` bytes long and all its bytes are in the file.
    bool fits(std::string_view type, std::size_t size)
    {
        std::size_t const end = at_ + size;
        for (FixedSize const& fixed : kFixedSizes)
            if (fixed.type == type) return size == fixed.bytes;
        if (type == "floatvector") return size % 4 == 0;
        if (type == "idmanifest") return false; // states its size after decompression; not needed here
        if (type == "preview") {
            if (size < 8) return false;
            std::uint64_t const width = number(), height = number();
            return (size - 8) % 4 == 0 && width * height == (size - 8) / 4;
        }
        if (type == "stringvector") {
            while (at_ < end) {
                std::size_t const length = number();
                if (at_ > end || length > end - at_) return false;
                at_ += length;
            }
            return true;
        }
        if (type == "chlist") {
            constexpr std::size_t kChannelBytes = 16;
            while (at_ < end) {
                if (text().empty()) return at_ == end;
                at_ = std::min(at_ + kChannelBytes, bytes_.size());
            }
            return false;
        }
        return true;
    }

    std::span<unsigned char const> bytes_;
    std::string const& name_;
    std::size_t at_ = 0;
};

} // namespace

InputError bad_exr(std::string const& name, std::string const& why)
{
    return {"cannot read '" + name + "' as OpenEXR", why,
            "exrheader shows what is in the file; copy it again if it was cut off, else save it as scanlines or "
            "tiles of half or float"};
}

void check_exr_header(std::span<unsigned char const> bytes, std::string const& name)
{
    HeaderWalk(bytes, name).check();
}

} // namespace gi
