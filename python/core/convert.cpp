#include "python/core/convert.h"

#include "gi/core/error.h"
#include "python/core/array.h"

#include <pybind11/stl.h>

namespace bindings {

py::dict to_layers(gi::Picture&& picture)
{
    py::dict layers;
    for (gi::Layer& layer : picture.layers) {
        std::vector<py::ssize_t> shape{picture.height, picture.width};
        if (layer.channels > 1) shape.push_back(layer.channels);
        layers[py::str(layer.name)] = own(std::move(layer.data), std::move(shape));
    }
    return layers;
}

gi::Picture to_picture(py::dict const& layers)
{
    gi::Picture picture;
    for (auto const& [key, value] : layers) {
        std::string const name = py::cast<std::string>(key);
        auto const buffer = py::cast<py::buffer>(value);
        FloatInput in = read_floats(buffer, int(buffer.request().ndim == 2 ? 2 : 3), "the layer " + name);
        int const height = int(in.shape[0]), width = int(in.shape[1]);
        int const channels = in.shape.size() == 2 ? 1 : int(in.shape[2]);
        if (channels != 1 && channels != 3 && channels != 4)
            throw gi::InputError("the layer " + name + " has " + std::to_string(channels) + " channels",
                                 "pictures have 1, 3 or 4", "leave the others out");
        if (!picture.layers.empty() && (picture.width != width || picture.height != height))
            throw gi::InputError("the layer " + name + " has another size than the layers before it",
                                 "layers of a picture have one size", "give them as two pictures");
        picture.width = width;
        picture.height = height;
        picture.layers.push_back({name, channels, std::move(in.values)});
    }
    return picture;
}

py::dict losses_of(gi::Report const& report)
{
    py::dict losses;
    for (auto const& [what, loss] : report.losses()) losses[py::str(what)] = loss.count;
    return losses;
}

nlohmann::json to_json(py::handle value)
{
    if (value.is_none()) return nullptr;
    if (py::isinstance<py::bool_>(value)) return py::cast<bool>(value);
    if (py::isinstance<py::int_>(value)) return py::cast<std::int64_t>(value);
    if (py::isinstance<py::float_>(value)) return py::cast<double>(value);
    if (py::isinstance<py::str>(value)) return py::cast<std::string>(value);
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
        auto list = nlohmann::json::array();
        for (py::handle const item : value) list.push_back(to_json(item));
        return list;
    }
    if (py::hasattr(value, "item") && py::hasattr(value, "tolist"))
        return to_json(value.attr("tolist")()); // numpy
    throw gi::InputError("a value of type " + std::string(py::str(py::type::of(value).attr("__name__"))),
                         "settings are strings, numbers, booleans and lists of numbers", "give one of these");
}

py::object from_json(nlohmann::json const& value)
{
    if (value.is_boolean()) return py::bool_(value.get<bool>());
    if (value.is_number_integer()) return py::int_(value.get<std::int64_t>());
    if (value.is_number()) return py::float_(value.get<double>());
    if (value.is_string()) return py::str(value.get<std::string>());
    if (value.is_array()) {
        py::list list;
        for (nlohmann::json const& item : value) list.append(from_json(item));
        return list;
    }
    return py::none();
}

} // namespace bindings
