// lightwell._core: the compiled part of the package in python/lightwell, which has the documentation.

#include "gi/core/processor_level.h"
#include "python/core/array.h"
#include "python/core/bind_frames.h"
#include "python/core/bind_image.h"
#include "python/core/bind_render.h"
#include "python/core/bind_scene.h"
#include "python/core/bind_study.h"
#include "python/core/errors.h"
#include "viewer/base/version.h"

PYBIND11_MODULE(_core, m)
{
    m.attr("version") = viewer::version_number();
    m.attr("git_hash") = viewer::git_hash();
    m.attr("level") = gi::kCompiledLevel;
    m.attr("embree_version") = viewer::embree_version();
    bindings::translate_errors();
    bindings::bind_array(m);
    bindings::bind_scene(m);
    bindings::bind_render(m);
    bindings::bind_image(m);
    bindings::bind_frames(m);
    bindings::bind_study(m);
}
