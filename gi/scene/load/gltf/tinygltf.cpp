#define TINYGLTF_IMPLEMENTATION
#include "gi/scene/load/gltf/tinygltf.h"
