#include "gi/core/file.h"
#include "gi/image_io/exr.h"
#include "gi/image_io/exr_output.h"
#include "gi/image_io/picture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfFramesPerSecond.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRational.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTimeCode.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <half.h>
#include <optional>

namespace gi {
namespace {

constexpr float kLargestHalf = 65504;

bool is_vector(std::string const& layer)
{
    return layer == "normal" || layer == "position" || layer.starts_with("motion_");
}

bool needs_single(std::string const& layer)
{
    return layer.starts_with("depth") || layer.starts_with("motion_") || layer == "position" ||
           layer.starts_with("variance");
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

/// @param clamped  is raised by the number of clamped values
std::vector<half> to_half(Layer const& layer, std::uint64_t& clamped)
{
    std::vector<half> values(layer.data.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        float v = layer.data[i];
        if (std::abs(v) > kLargestHalf && std::isfinite(v)) {
            v = std::copysign(kLargestHalf, v);
            ++clamped;
        }
        values[i] = half(v);
    }
    return values;
}

/// Both column vectors by columns, and row vectors by rows, are the same sixteen numbers in a row.
Imath::M44f matrix_of(dmat4 const& m)
{
    Imath::M44f out;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) out[i][j] = float(m[i][j]);
    return out;
}

void add(ExrAttributes const& a, Imf::Header& header)
{
    if (a.frames_per_s > 0) Imf::addFramesPerSecond(header, Imf::guessExactFps(a.frames_per_s));
    if (a.time_code) {
        ExrAttributes::TimeCode const& t = *a.time_code;
        Imf::addTimeCode(header, {t.hours, t.minutes, t.seconds, t.frame, false, false, t.is_second_field});
    }
    if (a.world_to_camera) Imf::addWorldToCamera(header, matrix_of(*a.world_to_camera));
    if (a.world_to_ndc) Imf::addWorldToNDC(header, matrix_of(*a.world_to_ndc));
}

/// One part of the file: a layer.
struct Part {
    Imf::OutputPart out;
    bool is_single = true;
    std::uint64_t clamped = 0;

    /// Writes the next rows. @param corner  of the first
    void write(Layer const& layer, int width, Imath::V2i corner, int count)
    {
        std::vector<half> const halves = is_single ? std::vector<half>() : to_half(layer, clamped);
        std::size_t const value = is_single ? sizeof(float) : sizeof(half);
        std::size_t const pixel = value * std::size_t(layer.channels), row = pixel * std::size_t(width);
        char const* const base = is_single ? reinterpret_cast<char const*>(layer.data.data())
                                           : reinterpret_cast<char const*>(halves.data());
        Imf::FrameBuffer buffer;
        for (int c = 0; c < layer.channels; ++c)
            buffer.insert(channel_name(layer, c),
                          Imf::Slice::Make(is_single ? Imf::FLOAT : Imf::HALF, base + std::size_t(c) * value,
                                           corner, width, count, pixel, row));
        out.setFrameBuffer(buffer);
        out.writePixels(count);
    }
};

} // namespace

std::optional<ExrAttributes::TimeCode> time_code_of(std::uint64_t frame, double frames_per_s)
{
    auto const rate = std::uint64_t(std::lround(std::min(frames_per_s, 1000.0)));
    if (!(frames_per_s > 0) || rate < 1 || rate > 60) return std::nullopt;
    std::uint64_t const second = frame / rate, within = frame % rate;
    if (second >= 24 * 3600) return std::nullopt;
    bool const has_pairs = rate > 30;
    return ExrAttributes::TimeCode{int(second / 3600), int(second / 60 % 60), int(second % 60),
                                   int(has_pairs ? within / 2 : within), has_pairs && within % 2 == 1};
}

void write_exr(std::filesystem::path const& file, Picture const& picture, PixelType type, Report& report,
               ExrAttributes const& attributes)
{
    write_exr(file, rows_of(picture), type, report, attributes);
}

void write_exr(std::filesystem::path const& file, PictureRows const& picture, PixelType type, Report& report,
               ExrAttributes const& attributes)
{
    auto const count_from = [&](int first) { return std::min(kRowsAtOnce, picture.height - first); };
    Picture rows = picture.read(0, count_from(0));
    std::vector<Imf::Header> headers;
    auto const is_single = [&](Layer const& l) { return type == PixelType::single || needs_single(l.name); };
    for (std::size_t l = 0; l < rows.layers.size(); ++l) {
        Layer const& layer = rows.layers[l];
        Imath::V2i const corner(picture.left, picture.top);
        Imath::Box2i const window(corner, corner + Imath::V2i(picture.width - 1, picture.height - 1));
        Imf::Header header(window, window);
        header.setName(layer.name);
        header.setType(Imf::SCANLINEIMAGE);
        header.compression() =
            attributes.compression == ExrCompression::zip ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
        Imf::addChromaticities(header, Imf::Chromaticities()); // the default is Rec. 709
        add(attributes, header);                               // such attributes are the same in all parts
        if (l == 0)
            for (auto const& [key, value] : picture.metadata)
                header.insert(std::string(kMetadataPrefix) + key, Imf::StringAttribute(value));
        for (int c = 0; c < layer.channels; ++c)
            header.channels().insert(channel_name(layer, c),
                                     Imf::Channel(is_single(layer) ? Imf::FLOAT : Imf::HALF));
        headers.push_back(header);
    }
    write_by_rename(file, [&](std::filesystem::path const& temporary) {
        ExrOutput stream(temporary);
        std::optional<Imf::MultiPartOutputFile> out;
        out.emplace(stream, headers.data(), int(headers.size()), false, 0);
        std::vector<Part> parts;
        for (std::size_t l = 0; l < rows.layers.size(); ++l)
            parts.push_back({Imf::OutputPart(*out, int(l)), is_single(rows.layers[l])});
        for (int y = 0; y < picture.height; y += kRowsAtOnce) {
            if (y > 0) rows = picture.read(y, count_from(y));
            for (std::size_t l = 0; l < parts.size(); ++l) {
                if (attributes.stop != nullptr && attributes.stop->requested()) throw Interrupted();
                parts[l].write(rows.layers[l], picture.width, {picture.left, picture.top + y}, count_from(y));
            }
        }
        out.reset(); // writes where the blocks are
        stream.finish();
        for (std::size_t l = 0; l < parts.size(); ++l)
            report.lose("values clamped to half float", parts[l].clamped, "layer '" + rows.layers[l].name + "'");
    });
}

} // namespace gi
