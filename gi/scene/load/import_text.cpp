#include "gi/scene/load/import_text.h"

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <memory>

namespace gi {

std::optional<std::string> import_text(std::string const& file, Assimp::IOSystem& files)
{
    auto const close = [&](Assimp::IOStream* stream) { files.Close(stream); };
    std::unique_ptr<Assimp::IOStream, decltype(close)> const stream(files.Open(file.c_str()), close);
    if (!stream) return std::nullopt;
    std::string text(stream->FileSize(), '\0');
    text.resize(stream->Read(text.data(), 1, text.size()));
    return text;
}

} // namespace gi
