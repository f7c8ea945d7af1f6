#define TINYGLTF_IMPLEMENTATION
#include "gi/scene/load/tinygltf.h"
