#pragma once
#include <optional>
#include <string>

namespace Assimp {
class IOSystem;
}

namespace gi {

/// The whole file, as Assimp's importers open it; nothing if it cannot be opened.
std::optional<std::string> import_text(std::string const& file, Assimp::IOSystem& files);

} // namespace gi
