#include "python/core/errors.h"

#include "gi/core/error.h"
#include "study/script/script_error.h"

#include <fmt/format.h>

namespace bindings {
namespace py = pybind11;
namespace {

void set_error(py::object const& error) { PyErr_SetObject(py::type::of(error).ptr(), error.ptr()); }

py::object error_class(char const* name) { return py::module_::import("lightwell.errors").attr(name); }

} // namespace

void translate_errors()
{
    py::register_exception_translator([](std::exception_ptr raised) {
        try {
            std::rethrow_exception(raised);
        } catch (study::ScriptError const& e) {
            set_error(error_class("ScriptError")(e.what(), e.problem(), e.why(), e.suggestion(), e.where().file,
                                                 e.where().line, e.where().column));
        } catch (gi::InputError const& e) {
            set_error(error_class("InputError")(e.what()));
        }
    });
}

void check_range(char const* name, double value, double low, double high)
{
    if (!(value >= low && value <= high))
        throw gi::InputError(fmt::format("{} = {}", name, value), fmt::format("it is {} to {}", low, high),
                             "choose a value in this range");
}

} // namespace bindings
