#include "ar/scene/albedo_file.h"

#include "gi/core/file.h"
#include "gi/core/yaml.h"

#include <algorithm>
#include <fmt/format.h>

namespace ar {
namespace {

/// In double quotes, whatever is in it.
std::string quoted(std::string const& text)
{
    std::string out = "\"";
    for (char const c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\x{:02x}", static_cast<unsigned>(c));
        else
            out += c;
    }
    return out + '"';
}

} // namespace

std::vector<AlbedoEntry> parse_albedos(std::string const& text, std::filesystem::path const& file)
{
    gi::Yaml const root = gi::Yaml::parse(text, file.string(), "albedos");
    root.only_keys({"schema", "albedos"});
    if (!root.has("schema") || root.at("schema").text() != "ar-albedo/1")
        throw root.error("no 'schema: ar-albedo/1'", "this may be a file of another kind",
                         "make it with lightwell ar albedo");
    std::vector<AlbedoEntry> entries;
    if (!root.has("albedos")) return entries;
    for (gi::Yaml const& y : root.at("albedos").items()) {
        y.only_keys({"name", "albedo", "spread", "samples", "texture"});
        for (char const* key : {"name", "albedo"})
            if (!y.has(key)) throw y.error(fmt::format("no '{}'", key), "every entry needs it", "add it");
        AlbedoEntry e;
        e.name = y.at("name").text();
        e.albedo = y.at("albedo").vector(0, 1);
        if (y.has("spread")) e.spread = y.at("spread").vector(0, 1e9);
        if (y.has("samples")) e.samples = std::uint64_t(y.at("samples").integer(0, INT64_MAX));
        if (y.has("texture")) e.texture = file.parent_path() / y.at("texture").text();
        if (std::any_of(entries.begin(), entries.end(), [&](AlbedoEntry const& f) { return f.name == e.name; }))
            throw y.error("'" + e.name + "' is there twice", "names must be unique", "remove one");
        entries.push_back(std::move(e));
    }
    return entries;
}

std::vector<AlbedoEntry> read_albedos(std::filesystem::path const& file)
{
    std::vector<unsigned char> const bytes = gi::read_bytes(file, std::size_t(16) << 20);
    return parse_albedos({bytes.begin(), bytes.end()}, file);
}

std::string format_albedos(std::vector<AlbedoEntry> const& entries)
{
    std::string text = fmt::format("schema: ar-albedo/1\nalbedos:{}\n", entries.empty() ? " []" : "");
    auto const vector = [](gi::dvec3 v) { return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", v.x, v.y, v.z); };
    for (AlbedoEntry const& e : entries)
        text += fmt::format("  - {{name: {}, albedo: {}, spread: {}, samples: {}{}}}\n", quoted(e.name),
                            vector(e.albedo), vector(e.spread), e.samples,
                            e.texture.empty() ? "" : ", texture: " + quoted(e.texture.filename().string()));
    return text;
}

} // namespace ar
