#pragma once
// Arrays owned by C++ that numpy reads in place through the buffer protocol (PEP 3118). The module therefore needs
// no numpy headers and works with any version of numpy.

#include <cstdint>
#include <memory>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace bindings {

namespace py = pybind11;

/// Row-major, dense array. References from Python keep the owner alive.
struct Array {
    std::shared_ptr<void const> owner;
    void const* data = nullptr;
    std::string format; ///< of one item, a format string of Python's module struct
    py::ssize_t item_bytes = 0;
    std::vector<py::ssize_t> shape;
    bool is_writable = false;
};

void bind_array(py::module_& m);

/// Returns a numpy.ndarray of the array's memory, without a copy.
py::object to_numpy(Array array);

/// Moves the values into an array that Python owns, without a copy.
template <class T>
py::object own(std::vector<T>&& values, std::vector<py::ssize_t> shape)
{
    auto const owner = std::make_shared<std::vector<T>>(std::move(values));
    return to_numpy({owner, owner->data(), py::format_descriptor<T>::format(), sizeof(T), std::move(shape), true});
}

/// Returns a read-only array of items owned by `owner`.
template <class Item>
py::object borrow(std::shared_ptr<void const> owner, Item const* data, std::vector<py::ssize_t> shape)
{
    return to_numpy(
        {std::move(owner), data, py::format_descriptor<Item>::format(), sizeof(Item), std::move(shape), false});
}

/// Copy of floats passed from Python. Throws InputError unless the buffer is non-empty, row-major, dense float32
/// with the given number of dimensions.
struct FloatInput {
    std::vector<float> values;
    std::vector<py::ssize_t> shape;
};
FloatInput read_floats(py::buffer const& buffer, int dimensions, std::string const& name);

} // namespace bindings
