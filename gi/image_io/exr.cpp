#include "gi/image_io/exr.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <string_view>

namespace gi {
namespace {

constexpr int kLargestSide = 65536;
constexpr std::size_t kMostValues = std::size_t(1) << 31;

/// Position of a channel in its layer; -1 = after the known channels.
int channel_order(std::string const& suffix)
{
    static constexpr std::array<std::string_view, 4> kOrders{"RGBA", "XYZW", "YV", "UV"};
    if (suffix.size() == 1)
        for (std::string_view const order : kOrders)
            if (auto const at = order.find(suffix[0]); at != std::string_view::npos) return int(at);
    return -1;
}

class MemoryStream : public Imf::IStream {
public:
    MemoryStream(std::span<unsigned char const> bytes, std::string const& name)
        : Imf::IStream(name.c_str()), bytes_(bytes)
    {
    }
    bool read(char c[], int n) override
    {
        if (n < 0 || std::uint64_t(n) > bytes_.size() - at_) throw Iex::InputExc("Unexpected end of file.");
        std::memcpy(c, bytes_.data() + at_, std::size_t(n));
        at_ += std::uint64_t(n);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override
    {
        if (position > bytes_.size()) throw Iex::InputExc("Seek beyond the end of the file.");
        at_ = position;
    }

private:
    std::span<unsigned char const> bytes_;
    std::uint64_t at_ = 0;
};

/// A channel of a file and the layer it belongs to.
struct SourceChannel {
    std::string name, layer;
    int order;
};

std::vector<SourceChannel> source_channels(Imf::Header const& header, std::string const& name)
{
    std::vector<SourceChannel> found;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            throw bad_exr(name, fmt::format("channel '{}' is sub-sampled", it.name()));
        std::string const full = it.name();
        auto const dot = full.rfind('.');
        found.push_back({full, dot == std::string::npos ? "color" : full.substr(0, dot),
                         channel_order(dot == std::string::npos ? full : full.substr(dot + 1))});
    }
    std::stable_sort(found.begin(), found.end(), [](SourceChannel const& a, SourceChannel const& b) {
        auto const last = [](int order) { return order < 0 ? 99 : order; };
        return std::pair(a.layer, last(a.order)) < std::pair(b.layer, last(b.order));
    });
    return found;
}

/// Upper bound of the compression ratio: constant pictures of 4096 x 4096 half floats reach 715 (ZIP), 710 (PIZ),
/// 11 (B44A), 3,443 (DWAA) and 11,660 (DWAB).
std::size_t largest_ratio(Imf::Compression compression)
{
    switch (compression) {
    case Imf::NO_COMPRESSION:
        return 1;
    case Imf::RLE_COMPRESSION:
        return 64;
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
        return 32;
    case Imf::DWAA_COMPRESSION:
    case Imf::DWAB_COMPRESSION:
        return 16384;
    default:
        return 2048;
    }
}

/// Minimum size of a part in bytes. Throws if the part is no picture of a sensible size.
std::size_t least_bytes(Imf::Header const& header, std::string const& name)
{
    if (header.hasType() && Imf::isDeepData(header.type())) throw bad_exr(name, "it holds deep data");
    Imath::Box2i const& window = header.dataWindow();
    auto const width = std::int64_t(window.max.x) - window.min.x + 1;
    auto const height = std::int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
        throw bad_exr(name, fmt::format("its size is {} x {}", width, height));
    std::size_t channels = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) ++channels;
    std::size_t const ratio = largest_ratio(header.compression());
    std::size_t const values = std::size_t(width) * std::size_t(height) * channels;
    if (values > kMostValues) throw bad_exr(name, fmt::format("it has {} values", values));
    if (header.hasTileDescription()) {
        Imf::TileDescription const& tiles = header.tileDescription();
        std::size_t const tile = std::size_t(tiles.xSize) * tiles.ySize;
        if (tiles.xSize > unsigned(kLargestSide) || tiles.ySize > unsigned(kLargestSide) ||
            tile * channels > kMostValues / 16)
            throw bad_exr(name, fmt::format("its tiles are {} x {}", tiles.xSize, tiles.ySize));
    }
    return values * sizeof(std::uint16_t) / ratio;
}

/// Reads the first and last rows, so that a damaged or hostile file fails before the whole picture is allocated.
void probe_rows(Imf::InputPart& input, std::vector<SourceChannel> const& channels, Imath::Box2i const& window)
{
    std::vector<float> row(std::size_t(window.max.x - window.min.x) + 1);
    for (int const y : {window.max.y, window.min.y}) {
        Imf::FrameBuffer buffer;
        for (SourceChannel const& c : channels)
            buffer.insert(c.name, Imf::Slice::Make(Imf::FLOAT, row.data(), {window.min.x, y}, int(row.size()), 1,
                                                   sizeof(float), sizeof(float) * row.size()));
        input.setFrameBuffer(buffer);
        input.readPixels(y);
    }
}

void read_part(Imf::MultiPartInputFile& file, int part, std::string const& name, Picture& picture)
{
    Imf::Header const& header = file.header(part);
    std::vector<SourceChannel> const channels = source_channels(header, name);
    Imath::Box2i const window = header.dataWindow();
    int const width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    if (part == 0) {
        picture.width = width;
        picture.height = height;
        for (auto it = header.begin(); it != header.end(); ++it)
            if (std::string_view const key = it.name(); key.starts_with(kMetadataPrefix))
                if (auto const* text = dynamic_cast<Imf::StringAttribute const*>(&it.attribute()))
                    picture.metadata[std::string(key.substr(kMetadataPrefix.size()))] = text->value();
    } else if (width != picture.width || height != picture.height) {
        throw bad_exr(name, "its parts differ in size");
    }

    Imf::InputPart input(file, part);
    probe_rows(input, channels, window);
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < channels.size();) {
        std::size_t end = i;
        while (end < channels.size() && channels[end].layer == channels[i].layer) ++end;
        std::string layer_name = channels[i].layer;
        if (picture.find(layer_name) != nullptr)
            layer_name = fmt::format("{}.{}", header.hasName() ? header.name() : std::to_string(part), layer_name);
        if (picture.find(layer_name) != nullptr) throw bad_exr(name, "two of its layers have the same name");
        Layer& layer = picture.add(layer_name, int(end - i));
        std::size_t const pixel = sizeof(float) * (end - i), row = pixel * std::size_t(width);
        for (std::size_t c = i; c < end; ++c)
            buffer.insert(channels[c].name, Imf::Slice::Make(Imf::FLOAT, layer.data.data() + (c - i), window.min,
                                                             width, height, pixel, row));
        i = end;
    }
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
}

} // namespace

Picture decode_exr(std::span<unsigned char const> bytes, std::string const& name)
{
    Picture picture;
    try {
        check_exr_header(bytes, name);
        MemoryStream stream(bytes, name);
        Imf::MultiPartInputFile file(stream, 0, false);
        if (file.parts() < 1) throw bad_exr(name, "it has no parts");
        std::size_t least = 0;
        for (int part = 0; part < file.parts(); ++part) least += least_bytes(file.header(part), name);
        if (least > bytes.size()) throw bad_exr(name, "it is far too short for the size in its header");
        for (int part = 0; part < file.parts(); ++part) read_part(file, part, name, picture);
    } catch (InputError const&) {
        throw;
    } catch (std::exception const& e) {
        throw bad_exr(name, e.what());
    }
    if (picture.layers.empty()) throw bad_exr(name, "it has no channels");
    return picture;
}

Picture read_exr(std::filesystem::path const& file) { return decode_exr(read_bytes(file), file.string()); }

} // namespace gi
