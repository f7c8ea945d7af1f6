#pragma once
// tinygltf parses the structure of a glTF file. gltf_document.h reads buffers and images, so that every byte that
// a file refers to is checked before it is read.

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_FS
#pragma GCC system_header
#include <fstream>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>
