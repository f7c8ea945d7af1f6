#include "python/core/bind_image.h"

#include "gi/core/error.h"
#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "gi/metrics/compare.h"
#include "gi/metrics/flip.h"
#include "python/core/array.h"
#include "python/core/convert.h"
#include "python/core/errors.h"

#include <pybind11/stl.h>

namespace bindings {
namespace {

gi::ToneMapSettings tone_of(double exposure_ev, std::string const& curve)
{
    check_range("exposure_ev", exposure_ev, -100, 100);
    if (curve != "srgb" && curve != "filmic")
        throw gi::InputError("curve = '" + curve + "'", "there is no such curve", "choose srgb or filmic");
    return {float(exposure_ev), curve == "filmic" ? gi::ToneCurve::filmic : gi::ToneCurve::srgb};
}

py::object tone_map(py::buffer const& color, double exposure_ev, std::string const& curve)
{
    gi::ToneMapSettings const settings = tone_of(exposure_ev, curve);
    FloatInput in = read_floats(color, 3, "color");
    gi::Layer const layer{"color", int(in.shape[2]), std::move(in.values)};
    std::vector<unsigned char> bytes;
    {
        py::gil_scoped_release const unlocked;
        bytes = gi::tone_map_bytes(layer, settings);
    }
    return own(std::move(bytes), {in.shape[0], in.shape[1], 3});
}

py::tuple compare(py::dict const& image, py::dict const& reference, std::vector<std::string> const& metrics,
                  std::string const& layer)
{
    gi::Picture const a = to_picture(image), b = to_picture(reference);
    gi::Comparison result;
    {
        py::gil_scoped_release const unlocked;
        result = gi::compare(a, b, metrics, layer);
    }
    py::dict values;
    for (gi::NamedValue const& v : result.values) values[py::str(v.name)] = v.value;
    return py::make_tuple(values, result.notes);
}

py::object flip_map(py::buffer const& image, py::buffer const& reference, bool hdr, double pixels_per_degree)
{
    check_range("pixels_per_degree", pixels_per_degree, 0.1, 1e4);
    FloatInput const a = read_floats(image, 3, "image"), b = read_floats(reference, 3, "reference");
    if (a.shape != b.shape || a.shape[2] != 3)
        throw gi::InputError("image and reference are not two arrays of height x width x 3 of one size",
                             "FLIP compares pixel with pixel", "resize one of them");
    std::vector<float> errors;
    {
        py::gil_scoped_release const unlocked;
        auto const measure = hdr ? gi::hdr_flip : gi::flip;
        errors = measure(a.values, b.values, int(a.shape[1]), int(a.shape[0]), float(pixels_per_degree));
    }
    return own(std::move(errors), {a.shape[0], a.shape[1]});
}

py::dict read_picture(std::string const& file)
{
    gi::Picture picture;
    {
        py::gil_scoped_release const unlocked;
        picture = gi::read_picture(file);
    }
    for (std::string const& note : picture.notes) py::module_::import("warnings").attr("warn")(file + ": " + note);
    return to_layers(std::move(picture));
}

void write_exr(std::string const& file, py::dict const& layers, bool half)
{
    gi::Picture const picture = to_picture(layers);
    if (picture.find("color") == nullptr)
        throw gi::InputError("there is no layer 'color'", "an EXR file needs it", "name one of the layers color");
    py::gil_scoped_release const unlocked;
    gi::Report report;
    gi::write_exr(file, picture, half ? gi::PixelType::half : gi::PixelType::single, report);
}

void write_png(std::string const& file, py::buffer const& bytes)
{
    py::buffer_info const info = bytes.request();
    bool const fits = info.ndim == 3 && (info.shape[2] == 3 || info.shape[2] == 4) && info.size > 0 &&
                      info.itemsize == 1 && info.strides[2] == 1 && info.strides[1] == info.shape[2] &&
                      info.strides[0] == info.shape[1] * info.shape[2];
    if (!fits)
        throw gi::InputError("PNG cannot hold this array", "it must be height x width x 3 or 4 contiguous uint8",
                             "give what tone_map returned");
    gi::write_png(file, int(info.shape[1]), int(info.shape[0]),
                  {static_cast<unsigned char const*>(info.ptr), std::size_t(info.size)});
}

} // namespace

void bind_image(py::module_& m)
{
    m.def("metrics", [] {
        std::map<std::string, std::string> metrics;
        for (gi::MetricInfo const& i : gi::metrics()) metrics.emplace(std::string(i.name), std::string(i.meaning));
        return metrics;
    });
    m.def("compare", &compare, py::arg("image"), py::arg("reference"), py::arg("metrics"), py::arg("layer"));
    m.def("flip_map", &flip_map, py::arg("image"), py::arg("reference"), py::arg("hdr"),
          py::arg("pixels_per_degree"));
    m.def("tone_map", &tone_map, py::arg("color"), py::arg("exposure_ev"), py::arg("curve"));
    m.def("read_picture", &read_picture, py::arg("file"));
    m.def("write_exr", &write_exr, py::arg("file"), py::arg("layers"), py::arg("half"));
    m.def("write_png", &write_png, py::arg("file"), py::arg("bytes"));
}

} // namespace bindings
