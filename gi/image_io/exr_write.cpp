#include "gi/core/file.h"
#include "gi/image_io/exr.h"
#include "gi/image_io/picture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <array>
#include <half.h>

namespace gi {
namespace {

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

} // namespace

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
