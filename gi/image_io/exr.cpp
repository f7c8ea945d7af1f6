#include "gi/image_io/exr.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/exr_layers.h"
#include "gi/image_io/luminance_chroma.h"
#include "gi/image_io/picture_file.h"

#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <string_view>

namespace gi {
namespace {

constexpr int kLargestSide = 65536;
constexpr std::size_t kMostValues = std::size_t(1) << 31;

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

std::size_t pixels_of(Imath::Box2i const& window, std::string const& name)
{
    auto const width = std::int64_t(window.max.x) - window.min.x + 1;
    auto const height = std::int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
        throw bad_exr(name, fmt::format("its size is {} x {}", width, height));
    return std::size_t(width) * std::size_t(height);
}

std::size_t channels_of(Imf::Header const& header)
{
    std::size_t channels = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) ++channels;
    return channels;
}

/// Minimum size of a part in bytes. Throws if the part is no picture of a sensible size.
std::size_t least_bytes(Imf::Header const& header, std::string const& name)
{
    std::size_t const channels = channels_of(header), ratio = largest_ratio(header.compression());
    std::size_t const pixels = pixels_of(header.dataWindow(), name), values = pixels * channels;
    std::size_t samples = 0; // of sub-sampled channels there are fewer
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
        samples += pixels / (std::size_t(std::max(1, it.channel().xSampling)) *
                             std::size_t(std::max(1, it.channel().ySampling)));
    if (values > kMostValues) throw bad_exr(name, fmt::format("it has {} values", values));
    if (header.hasTileDescription()) {
        Imf::TileDescription const& tiles = header.tileDescription();
        std::size_t const tile = std::size_t(tiles.xSize) * tiles.ySize;
        if (tiles.xSize > unsigned(kLargestSide) || tiles.ySize > unsigned(kLargestSide) ||
            tile * channels > kMostValues / 16)
            throw bad_exr(name, fmt::format("its tiles are {} x {}", tiles.xSize, tiles.ySize));
    }
    return samples * sizeof(std::uint16_t) / ratio;
}

int width_of(Imath::Box2i const& window) { return window.max.x - window.min.x + 1; }
int height_of(Imath::Box2i const& window) { return window.max.y - window.min.y + 1; }

/// Reads the first and last rows, so that a damaged or hostile file fails before the whole picture is allocated.
void probe_rows(Imf::InputPart& input, std::vector<ExrLayer> const& layers, Imath::Box2i const& window)
{
    std::vector<float> row(std::size_t(width_of(window)));
    for (int const y : {window.max.y, window.min.y}) {
        Imf::FrameBuffer buffer;
        for (ExrLayer const& layer : layers)
            for (ExrChannel const& c : layer.channels)
                buffer.insert(c.name,
                              Imf::Slice::Make(Imf::FLOAT, row.data(), {window.min.x, y}, int(row.size()), 1,
                                               sizeof(float), sizeof(float) * row.size(), c.step_x, c.step_y));
        input.setFrameBuffer(buffer);
        input.readPixels(y);
    }
}

/// One part of the file.
struct SourcePart {
    int number;
    std::string name; ///< its number where it has none
    std::vector<ExrLayer> layers;
    Imath::Box2i data;

    /// The colours without a layer; null if there are none.
    ExrLayer const* colors() const
    {
        auto const it = std::ranges::find_if(layers, [](ExrLayer const& l) { return l.name.empty(); });
        return it == layers.end() ? nullptr : &*it;
    }
};

/// Values of a layer over the data window of its part.
struct Values {
    std::vector<SparsePlane> planes; ///< of luminance and chroma
    std::vector<float> data;         ///< of others: channels interleaved
};

/// Where the channels of a layer are written to.
void add_slices(ExrLayer const& layer, Imath::Box2i const& window, Values& to, Imf::FrameBuffer& buffer)
{
    auto const width = std::size_t(width_of(window)), height = std::size_t(height_of(window));
    std::size_t const n = layer.channels.size(), pixel = sizeof(float) * n;
    if (layer.kind != ExrKind::luminance_chroma) {
        to.data.assign(width * height * n, 0.0f);
        for (std::size_t c = 0; c < n; ++c)
            buffer.insert(layer.channels[c].name,
                          Imf::Slice::Make(Imf::FLOAT, to.data.data() + c, window, pixel, pixel * width));
        return;
    }
    to.planes.resize(n);
    for (std::size_t c = 0; c < n; ++c) {
        SparsePlane& p = to.planes[c];
        p.step_x = layer.channels[c].step_x;
        p.step_y = layer.channels[c].step_y;
        std::size_t const columns = (width + std::size_t(p.step_x) - 1) / std::size_t(p.step_x),
                          rows = (height + std::size_t(p.step_y) - 1) / std::size_t(p.step_y);
        p.values.assign(columns * rows, 0.0f);
        buffer.insert(layer.channels[c].name, Imf::Slice::Make(Imf::FLOAT, p.values.data(), window, sizeof(float),
                                                               sizeof(float) * columns, p.step_x, p.step_y));
    }
}

/// Turns values into those of a Layer. @return its number of channels
int finish(ExrKind kind, int width, int height, glm::dvec3 weights, Values& v, std::size_t channels)
{
    auto const pixels = std::size_t(width) * std::size_t(height);
    if (kind == ExrKind::luminance_alpha) {
        std::vector<float> rgba(4 * pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            for (std::size_t c = 0; c < 3; ++c) rgba[4 * i + c] = v.data[2 * i];
            rgba[4 * i + 3] = v.data[2 * i + 1];
        }
        v.data = std::move(rgba);
        return 4;
    }
    if (kind != ExrKind::luminance_chroma) return int(channels);
    std::size_t const n = channels; // R, G, B (, A) take the places of Y, RY, BY (, A)
    std::vector<float> const ry = spread(v.planes[1], width, height), by = spread(v.planes[2], width, height);
    v.data.resize(n * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        vec3 const c = rgb_of(v.planes[0].values[i], ry[i], by[i], weights);
        for (std::size_t k = 0; k < 3; ++k) v.data[n * i + k] = c[int(k)];
        if (n == 4) v.data[n * i + 3] = v.planes[3].values[i];
    }
    v.planes.clear();
    return int(n);
}

/// The pixels of the data window that lie in the picture, whose corner is (left, top); 0 elsewhere.
std::vector<float> placed(std::vector<float> values, Imath::Box2i const& data, int channels,
                          Picture const& picture)
{
    int const x0 = std::max(data.min.x, picture.left), x1 = std::min(data.max.x + 1, picture.left + picture.width);
    int const y0 = std::max(data.min.y, picture.top), y1 = std::min(data.max.y + 1, picture.top + picture.height);
    auto const n = std::size_t(channels), from_width = std::size_t(width_of(data));
    if (x1 - x0 == picture.width && y1 - y0 == picture.height && values.size() == picture.pixels() * n)
        return values;
    std::vector<float> out(picture.pixels() * n, 0.0f);
    for (int y = y0; y < y1 && x0 < x1; ++y)
        std::copy_n(
            &values[(std::size_t(y - data.min.y) * from_width + std::size_t(x0 - data.min.x)) * n],
            std::size_t(x1 - x0) * n,
            &out[(std::size_t(y - picture.top) * std::size_t(picture.width) + std::size_t(x0 - picture.left)) *
                 n]);
    return out;
}

void read_part(Imf::MultiPartInputFile& file, SourcePart const& part, bool gives_color, bool is_color_taken,
               std::string const& name, Picture& picture)
{
    Imf::InputPart input(file, part.number);
    probe_rows(input, part.layers, part.data);
    Imf::FrameBuffer buffer;
    std::vector<Values> values(part.layers.size());
    for (std::size_t l = 0; l < values.size(); ++l) add_slices(part.layers[l], part.data, values[l], buffer);
    input.setFrameBuffer(buffer);
    input.readPixels(part.data.min.y, part.data.max.y);
    dvec3 const weights = *luminance_weights(picture.primaries.value_or(Primaries{}));
    for (std::size_t l = 0; l < values.size(); ++l) {
        ExrLayer const& layer = part.layers[l];
        bool const is_bare = layer.name.empty();
        std::string full = is_bare ? "color" : layer.name;
        if (picture.find(full) != nullptr || (full == "color" && is_color_taken && !(is_bare && gives_color)))
            full = part.name + "." + full;
        if (picture.find(full) != nullptr) throw bad_exr(name, "two of its layers are named '" + full + "'");
        int const channels = finish(layer.kind, width_of(part.data), height_of(part.data), weights, values[l],
                                    layer.channels.size());
        picture.layers.push_back(
            {full, channels, placed(std::move(values[l].data), part.data, channels, picture)});
    }
}

/// The part with the colours of the picture: the first with R, G, B (or Y, RY, BY) without a layer, then with Y.
SourcePart const* part_of_color(std::vector<SourcePart> const& parts)
{
    auto const with = [&](auto const& fits) {
        auto const it = std::ranges::find_if(
            parts, [&](SourcePart const& p) { return p.colors() != nullptr && fits(p.colors()->kind); });
        return it == parts.end() ? nullptr : &*it;
    };
    SourcePart const* const rgb =
        with([](ExrKind k) { return k == ExrKind::rgb || k == ExrKind::luminance_chroma; });
    return rgb != nullptr ? rgb : with([](ExrKind) { return true; });
}

/// Says which part has the colours, where another has channels without a layer too.
void say_choice(std::vector<SourcePart> const& parts, SourcePart const& color, Picture& picture)
{
    std::string others;
    for (SourcePart const& p : parts) {
        std::string channels;
        for (ExrLayer const& l : p.layers)
            for (ExrChannel const& c : l.channels)
                if (c.name.find('.') == std::string::npos) channels += (channels.empty() ? "" : ", ") + c.name;
        if (&p == &color || channels.empty()) continue;
        others += fmt::format("{}'{}' ({})", others.empty() ? "" : ", ", p.name, channels);
    }
    if (!others.empty())
        picture.notes.push_back(fmt::format("its colours are those of its part '{}'; parts not taken for them: {}",
                                            color.name, others));
}

/// The window of a picture: the display window. Of environments that say so the data window
/// (ImfEnvmap.h: their poles are at its borders).
Imath::Box2i window_of(Imf::Header const& header)
{
    return Imf::hasEnvmap(header) ? header.dataWindow() : header.displayWindow();
}

void take_window(Imf::Header const& header, std::size_t values_in_file, std::size_t channels,
                 std::string const& name, Picture& picture)
{
    constexpr std::size_t kMuch = std::size_t(1) << 28; // 1 GiB
    Imath::Box2i const window = window_of(header);
    std::size_t const values = pixels_of(window, name) * channels;
    if (values > kMuch && values / 64 > values_in_file)
        throw bad_exr(name, fmt::format("its display window is {} x {} for little data", width_of(window),
                                        height_of(window)));
    if (values > kMostValues)
        throw bad_exr(name,
                      fmt::format("its {} channels (of all parts) of {} x {} pixels are {} values, more than "
                                  "{}",
                                  channels, width_of(window), height_of(window), values, kMostValues));
    picture.left = window.min.x;
    picture.top = window.min.y;
    picture.width = width_of(window);
    picture.height = height_of(window);
}

/// @param whose  "its", or which part's
void say_windows(Imath::Box2i const& data, std::string const& whose, Picture& picture)
{
    auto const inside = [](int low, int high, int from, int count) {
        return std::int64_t(std::min(std::int64_t(high), std::int64_t(from) + count - 1)) - std::max(low, from) +
               1;
    };
    std::int64_t const w = inside(data.min.x, data.max.x, picture.left, picture.width),
                       h = inside(data.min.y, data.max.y, picture.top, picture.height);
    picture.has_gaps = picture.has_gaps || w < picture.width || h < picture.height;
    if (w <= 0 || h <= 0) {
        picture.notes.push_back(whose + " data window lies outside of the display window: all pixels are 0");
        return;
    }
    if (w < picture.width || h < picture.height)
        picture.notes.push_back(fmt::format("{} data window covers {} x {} of {} x {} pixels, the others are 0",
                                            whose, w, h, picture.width, picture.height));
    if (w < width_of(data) || h < height_of(data))
        picture.notes.push_back(fmt::format("{} {} x {} pixels are cut to the {} x {} in the display window",
                                            whose, width_of(data), height_of(data), w, h));
}

Primaries primaries_of(Imf::Header const& header, std::string const& name)
{
    if (!Imf::hasChromaticities(header)) return {};
    Imf::Chromaticities const& c = Imf::chromaticities(header);
    auto const xy = [](Imath::V2f const& v) { return glm::dvec2(v.x, v.y); };
    Primaries const p{xy(c.red), xy(c.green), xy(c.blue), xy(c.white)};
    if (!luminance_weights(p) || !to_rec709(p)) throw bad_exr(name, "its chromaticities span no colours");
    return p;
}

/// What the header says of the whole picture.
void take_facts(Imf::Header const& header, std::string const& name, Picture& picture)
{
    if (Primaries const p = primaries_of(header, name); !p.is_rec709()) picture.primaries = p;
    picture.is_cube = Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE;
    if (float const ratio = header.pixelAspectRatio(); std::abs(ratio - 1) > 1e-3f)
        picture.notes.push_back(
            fmt::format("its pixels, {:.4g} times as wide as high, are taken as square", ratio));
}

Picture decode(std::span<unsigned char const> bytes, std::string const& name)
{
    Picture picture;
    check_exr_header(bytes, name);
    MemoryStream stream(bytes, name);
    Imf::MultiPartInputFile file(stream, 0, false);
    if (file.parts() < 1) throw bad_exr(name, "it has no parts");
    std::vector<SourcePart> parts;
    std::size_t least = 0, channels = 0, values = 0;
    for (int i = 0; i < file.parts(); ++i) {
        Imf::Header const& header = file.header(i);
        std::string const part = header.hasName() ? header.name() : std::to_string(i);
        if (header.hasType() && Imf::isDeepData(header.type())) {
            if (file.parts() == 1) throw bad_exr(name, "it holds deep data");
            picture.notes.push_back("its part '" + part + "' holds deep data and is left out");
            continue;
        }
        least += least_bytes(header, name);
        channels += channels_of(header);
        values += pixels_of(header.dataWindow(), name) * channels_of(header);
        parts.push_back({i, part, exr_layers(header.channels(), name), header.dataWindow()});
    }
    if (parts.empty()) throw bad_exr(name, "all its parts hold deep data");
    if (least > bytes.size()) throw bad_exr(name, "it is far too short for the size in its header");
    SourcePart const* const color = part_of_color(parts);
    SourcePart const& main = color != nullptr ? *color : parts.front();
    take_window(file.header(main.number), values, channels, name, picture);
    take_facts(file.header(main.number), name, picture);
    if (color != nullptr) say_choice(parts, *color, picture);
    for (SourcePart const& p : parts)
        if (&p == &main || p.data != main.data)
            say_windows(p.data, &p == &main ? "its" : "its part '" + p.name + "':", picture);
    Imf::Header const& first = file.header(0);
    for (auto it = first.begin(); it != first.end(); ++it)
        if (std::string_view const key = it.name(); key.starts_with(kMetadataPrefix))
            if (auto const* text = dynamic_cast<Imf::StringAttribute const*>(&it.attribute()))
                picture.metadata[std::string(key.substr(kMetadataPrefix.size()))] = text->value();
    for (SourcePart const& part : parts) read_part(file, part, &part == color, color != nullptr, name, picture);
    return picture;
}

} // namespace

Picture decode_exr(std::span<unsigned char const> bytes, std::string const& name)
{
    try {
        Picture picture = decode(bytes, name);
        if (picture.layers.empty()) throw bad_exr(name, "it has no channels");
        return picture;
    } catch (InputError const&) {
        throw;
    } catch (std::exception const& e) {
        throw bad_exr(name, e.what());
    }
}

Picture read_exr(std::filesystem::path const& file) { return decode_exr(read_bytes(file), file.string()); }

} // namespace gi
