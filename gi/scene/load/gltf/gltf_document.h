#pragma once
// An opened glTF file: its structure parsed by tinygltf, its bytes as checked spans. Errors that concern the file
// as a whole throw InputError here.

#include "gi/core/error.h"
#include "gi/core/report.h"
#include "gi/scene/load/gltf/tinygltf.h"

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gi {

using Bytes = std::span<unsigned char const>;

struct GltfImage {
    std::string name;
    Bytes bytes; ///< encoded; empty = missing (counted)
};

struct GltfDocument {
    std::string name; ///< for messages
    tinygltf::Model model;
    std::vector<Bytes> buffers;
    std::vector<GltfImage> images;
    /// Owns data that was decoded or read from other files.
    std::vector<std::unique_ptr<std::vector<unsigned char>>> storage;
    std::map<int, Bytes> decoded_views; ///< decoded by EXT_meshopt_compression
    std::vector<std::string> files;     ///< other files that were read
    std::size_t file_bytes = 0;         ///< including all buffers
    std::size_t elements_read = 0;

    InputError error(std::string const& problem, std::string const& why) const
    {
        return {name + ": " + problem, why,
                "the glTF validator names the place; Blender exports files that pass it"};
    }
    /// Counts array elements about to be created. Throws InputError if a small file would create a huge scene:
    /// data may be used several times, but not without limit.
    void spend(std::size_t elements, std::string const& what);
    Bytes own(std::vector<unsigned char> bytes)
    {
        storage.push_back(std::make_unique<std::vector<unsigned char>>(std::move(bytes)));
        return *storage.back();
    }
    /// Returns the bytes of a buffer view, decompressed if necessary.
    /// Throws InputError if it lies outside its buffer.
    Bytes view_bytes(int view);
};

/// @param bytes  glTF JSON or GLB; must outlive the document
/// @param folder in which other files are searched; empty = none allowed
GltfDocument open_gltf(Bytes bytes, std::filesystem::path const& folder, std::string const& name, Report& report);

} // namespace gi
