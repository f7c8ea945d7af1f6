#include "gi/base/error.h"
#include "gi/base/file.h"
#include "gi/base/picture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <half.h>
#include <string_view>

namespace gi {
namespace {

constexpr std::string_view kMetadataPrefix = "lightwell:";
constexpr int kLargestSide = 65536;
constexpr std::size_t kMostValues = std::size_t(1) << 31;
constexpr float kLargestHalf = 65504;

bool is_vector(std::string const& layer) { return layer == "normal" || layer == "position"; }

bool needs_single(std::string const& layer)
{
    return layer == "depth" || layer == "position" || layer.starts_with("variance");
}

/// Suffix of channel c of a layer, in the order of its data.
std::string channel_name(Layer const& layer, int c)
{
    static constexpr std::array kColor{"R", "G", "B", "A"}, kVector{"X", "Y", "Z", "W"};
    auto const i = std::size_t(c);
    bool const beauty = layer.name == "color";
    if (layer.channels == 1) return beauty ? "Y" : layer.name + ".V";
    std::string const suffix = is_vector(layer.name) ? kVector[i] : kColor[i];
    return beauty ? suffix : layer.name + "." + suffix;
}

/// Where a channel belongs in its layer; -1 = after the known ones.
int channel_order(std::string const& suffix)
{
    static constexpr std::array<std::string_view, 4> kOrders{"RGBA", "XYZW", "YV", "UV"};
    if (suffix.size() == 1)
        for (std::string_view const order : kOrders)
            if (auto const at = order.find(suffix[0]); at != std::string_view::npos) return int(at);
    return -1;
}

std::vector<half> to_half(Layer const& layer, Report& report)
{
    std::vector<half> values(layer.data.size());
    std::uint64_t clamped = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        float v = layer.data[i];
        if (std::abs(v) > kLargestHalf && std::isfinite(v)) {
            v = std::copysign(kLargestHalf, v);
            ++clamped;
        }
        values[i] = half(v);
    }
    report.lose("values clamped to half float", clamped, "layer '" + layer.name + "'");
    return values;
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

InputError bad_exr(std::string const& name, std::string const& why)
{
    return {"cannot read '" + name + "' as OpenEXR", why, "check the file with exrheader or save it again"};
}

/// A channel of a file and the layer it goes to.
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

/// A file may not ask for more than it can hold: the strongest compression seen is some 1000:1.
void check_size(Imf::Header const& header, std::size_t channels, std::size_t file_bytes, std::string const& name)
{
    Imath::Box2i const& window = header.dataWindow();
    auto const width = std::int64_t(window.max.x) - window.min.x + 1;
    auto const height = std::int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
        throw bad_exr(name, fmt::format("its size is {} x {}", width, height));
    std::size_t const values = std::size_t(width) * std::size_t(height) * channels;
    if (values > kMostValues || values / 4096 > file_bytes)
        throw bad_exr(name, fmt::format("{} x {} pixels of {} channels do not fit a file of {} bytes", width,
                                        height, channels, file_bytes));
    if (header.hasType() && Imf::isDeepData(header.type())) throw bad_exr(name, "it holds deep data");
    if (header.hasTileDescription()) {
        Imf::TileDescription const& tiles = header.tileDescription();
        if (tiles.xSize > unsigned(kLargestSide) || tiles.ySize > unsigned(kLargestSide) ||
            std::size_t(tiles.xSize) * tiles.ySize > kMostValues / 16 ||
            std::size_t(tiles.xSize) * tiles.ySize / 4096 > file_bytes)
            throw bad_exr(name, fmt::format("its tiles are {} x {}", tiles.xSize, tiles.ySize));
    }
}

void read_part(Imf::MultiPartInputFile& file, int part, std::string const& name, std::size_t file_bytes,
               Picture& picture)
{
    Imf::Header const& header = file.header(part);
    std::vector<SourceChannel> const channels = source_channels(header, name);
    check_size(header, channels.size(), file_bytes, name);
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
    Imf::InputPart input(file, part);
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
}

} // namespace

Picture decode_exr(std::span<unsigned char const> bytes, std::string const& name)
{
    Picture picture;
    try {
        MemoryStream stream(bytes, name);
        Imf::MultiPartInputFile file(stream, 0, false);
        if (file.parts() < 1) throw bad_exr(name, "it has no parts");
        for (int part = 0; part < file.parts(); ++part) read_part(file, part, name, bytes.size(), picture);
    } catch (InputError const&) {
        throw;
    } catch (std::exception const& e) {
        throw bad_exr(name, e.what());
    }
    if (picture.layers.empty()) throw bad_exr(name, "it has no channels");
    return picture;
}

Picture read_exr(std::filesystem::path const& file) { return decode_exr(read_bytes(file), file.string()); }

void write_exr(std::filesystem::path const& file, Picture const& picture, PixelType type, Report& report)
{
    std::vector<Imf::Header> headers;
    std::vector<std::vector<half>> halves(picture.layers.size());
    for (std::size_t l = 0; l < picture.layers.size(); ++l) {
        Layer const& layer = picture.layers[l];
        Imf::Header header(picture.width, picture.height);
        header.setName(layer.name);
        header.setType(Imf::SCANLINEIMAGE);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::addChromaticities(header, Imf::Chromaticities()); // the default is Rec. 709
        if (l == 0)
            for (auto const& [key, value] : picture.metadata)
                header.insert(std::string(kMetadataPrefix) + key, Imf::StringAttribute(value));
        bool const single = type == PixelType::single || needs_single(layer.name);
        if (!single) halves[l] = to_half(layer, report);
        for (int c = 0; c < layer.channels; ++c)
            header.channels().insert(channel_name(layer, c), Imf::Channel(single ? Imf::FLOAT : Imf::HALF));
        headers.push_back(header);
    }
    write_by_rename(file, [&](std::filesystem::path const& temporary) {
        Imf::MultiPartOutputFile out(temporary.c_str(), headers.data(), int(headers.size()), false, 0);
        for (std::size_t l = 0; l < picture.layers.size(); ++l) {
            Layer const& layer = picture.layers[l];
            bool const single = halves[l].empty();
            std::size_t const value = single ? sizeof(float) : sizeof(half);
            std::size_t const pixel = value * std::size_t(layer.channels),
                              row = pixel * std::size_t(picture.width);
            char const* const base = single ? reinterpret_cast<char const*>(layer.data.data())
                                            : reinterpret_cast<char const*>(halves[l].data());
            Imf::FrameBuffer buffer;
            for (int c = 0; c < layer.channels; ++c)
                buffer.insert(channel_name(layer, c),
                              Imf::Slice::Make(single ? Imf::FLOAT : Imf::HALF, base + std::size_t(c) * value,
                                               Imath::V2i(0), picture.width, picture.height, pixel, row));
            Imf::OutputPart part(out, int(l));
            part.setFrameBuffer(buffer);
            part.writePixels(picture.height);
        }
    });
}

} // namespace gi
