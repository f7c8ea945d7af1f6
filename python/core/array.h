#pragma once
// Arrays that C++ owns and numpy reads where they lie, by the buffer protocol (PEP 3118): the module is built
// without numpy's headers and works with any version of it.

#include <cstdint>
#include <memory>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace bindings {

namespace py = pybind11;

/// Row-major, dense. What Python holds of it keeps the owner alive.
struct Array {
    std::shared_ptr<void const> owner;
    void const* data = nullptr;
    std::string format; ///< of one item, as the module struct has it
    py::ssize_t item_bytes = 0;
    std::vector<py::ssize_t> shape;
    bool is_writable = false;
};

void bind_array(py::module_& m);

/// numpy.ndarray of it, without a copy.
py::object to_numpy(Array array);

/// An array of its own, without a copy.
template <class T>
py::object own(std::vector<T>&& values, std::vector<py::ssize_t> shape)
{
    auto const owner = std::make_shared<std::vector<T>>(std::move(values));
    return to_numpy({owner, owner->data(), py::format_descriptor<T>::format(), sizeof(T), std::move(shape), true});
}

/// Of items that somebody else owns; read-only.
template <class Item>
py::object borrow(std::shared_ptr<void const> owner, Item const* data, std::vector<py::ssize_t> shape)
{
    return to_numpy(
        {std::move(owner), data, py::format_descriptor<Item>::format(), sizeof(Item), std::move(shape), false});
}

/// Floats that Python gives, copied. Throws InputError where the buffer is not float32 and dense in rows, has not
/// so many dimensions, or is empty.
struct FloatInput {
    std::vector<float> values;
    std::vector<py::ssize_t> shape;
};
FloatInput read_floats(py::buffer const& buffer, int dimensions, std::string const& name);

} // namespace bindings
