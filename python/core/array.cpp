#include "python/core/array.h"

#include "gi/core/error.h"

#include <algorithm>
#include <numeric>

namespace bindings {

void bind_array(py::module_& m)
{
    py::class_<Array>(m, "Array", py::buffer_protocol(),
                      "Memory of the renderer; numpy.asarray() reads it in place.")
        .def_buffer([](Array& a) {
            std::vector<py::ssize_t> strides(a.shape.size(), a.item_bytes);
            for (std::size_t k = a.shape.size(); k > 1; --k) strides[k - 2] = strides[k - 1] * a.shape[k - 1];
            return py::buffer_info(const_cast<void*>(a.data), a.item_bytes, a.format, py::ssize_t(a.shape.size()),
                                   a.shape, strides, !a.is_writable);
        });
}

py::object to_numpy(Array array)
{
    static char const nothing[64] = {};
    if (array.data == nullptr) array.data = nothing; // an array without items
    return py::module_::import("numpy").attr("asarray")(py::cast(std::move(array)));
}

FloatInput read_floats(py::buffer const& buffer, int dimensions, std::string const& name)
{
    py::buffer_info const info = buffer.request();
    bool is_dense = info.ndim == dimensions && info.format == py::format_descriptor<float>::format();
    py::ssize_t stride = sizeof(float);
    for (py::ssize_t k = info.ndim; k > 0 && is_dense; --k) {
        is_dense = info.strides[std::size_t(k - 1)] == stride || info.shape[std::size_t(k - 1)] == 1;
        stride *= info.shape[std::size_t(k - 1)];
    }
    if (!is_dense || info.size == 0)
        throw gi::InputError(name + " is no picture",
                             "it must have " + std::to_string(dimensions) +
                                 " dimensions, none of them empty, and contiguous float32 items",
                             "give numpy.ascontiguousarray(x, numpy.float32) of height x width x channels");
    auto const* const first = static_cast<float const*>(info.ptr);
    return {{first, first + info.size}, info.shape};
}

} // namespace bindings
