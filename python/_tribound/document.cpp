#include "python/_tribound/document.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/keys.h"

namespace tribound::python
{

namespace py = pybind11;

namespace
{

/// A function of Python. Its owners in C++ do not hold the interpreter's lock.
using SharedFunction = std::shared_ptr<const py::object>;

SharedFunction shared(py::object function)
{
  return {new py::object(std::move(function)), [](const py::object* owned)
          {
            const py::gil_scoped_acquire lock;
            delete owned;
          }};
}

/// The points as an array of shape (dim, n) of its own: the function may keep it.
py::array_t<double> to_array(std::span<const double> points, int dim)
{
  const auto n = static_cast<py::ssize_t>(points.size()) / dim;
  py::array_t<double> array(std::vector<py::ssize_t>{dim, n});
  auto entries = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < n; ++i)
    for (py::ssize_t d = 0; d < dim; ++d) entries(d, i) = points[i * dim + d];
  return array;
}

/// What a function has returned, one number for each point or one for all. Throws InputError.
void take(const py::object& returned, const Where& where, std::span<double> values)
{
  const std::string hint =
      fmt::format("one number per point, an array of shape ({},), or one number", values.size());
  const auto array = py::array::ensure(returned);
  if (!array || std::string_view("fiub").find(array.dtype().kind()) == std::string_view::npos)
    throw InputError(
        where,
        fmt::format("the function returns {}, no numbers",
                    array && array.ndim() > 0
                        ? py::str(array.dtype()).cast<std::string>()
                        : py::str(py::type::handle_of(returned).attr("__name__")).cast<std::string>()),
        hint);
  const py::array_t<double, py::array::c_style | py::array::forcecast> numbers(array);
  const bool is_one = numbers.ndim() == 0;
  if (!is_one && (numbers.ndim() != 1 || numbers.size() != static_cast<py::ssize_t>(values.size())))
    throw InputError(where,
                     fmt::format("the function returns an array of shape {} for {} points",
                                 py::str(array.attr("shape")).cast<std::string>(), values.size()),
                     hint);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = numbers.data()[is_one ? 0 : i];
}

/// `t`: the load factor, an argument of functions that use it.
problem::FieldFunction field_function(const SharedFunction& function, const Where& where, int degree,
                                      bool uses_time, double t)
{
  problem::FieldFunction field;
  field.degree = degree;
  field.values = [=](std::span<const double> points, int dim, std::span<double> values)
  {
    const py::gil_scoped_acquire lock;
    const py::array_t<double> x = to_array(points, dim);
    take(uses_time ? (*function)(x, t) : (*function)(x), where, values);
  };
  if (uses_time)
    field.at = [=](double other) { return field_function(function, where, degree, true, other); };
  return field;
}

problem::FieldFunction to_function(const py::handle& value, const Where& where)
{
  const py::object degree = value.attr("degree");
  return field_function(shared(value.attr("call")), where,
                        degree.is_none() ? problem::FieldFunction::not_polynomial : degree.cast<int>(),
                        value.attr("uses_time").cast<bool>(), 1);
}

std::int64_t to_integer(const py::handle& value, const Where& where)
{
  try
  {
    return value.cast<std::int64_t>();
  }
  catch (const py::cast_error&)
  {
    throw InputError(where, "is an integer of more than 64 bits", "an ordinary number");
  }
}

case_file::Node::Table to_table(const py::dict& dictionary, const std::string& name, const std::string& key)
{
  case_file::Node::Table table;
  for (const auto& [entry, value] : dictionary)
  {
    if (!py::isinstance<py::str>(entry))
      throw InputError({.file = name, .key = key},
                       fmt::format("has the key {}, no string", py::repr(entry).cast<std::string>()),
                       "keys are strings");
    const auto text = entry.cast<std::string>();
    const std::string inner = case_file::dotted_key(key, text);
    // Not in the list below: GCC 12 frees its other entries twice where this throws.
    case_file::Node node = to_node(value, name, inner);
    table.push_back({text, node.where, std::move(node)});
  }
  return table;
}

case_file::Node::Array to_items(const py::handle& sequence, const std::string& name, const std::string& key)
{
  case_file::Node::Array items;
  std::size_t number = 0;
  for (const py::handle item : sequence)
    items.push_back(to_node(item, name, fmt::format("{}[{}]", key, number++)));
  return items;
}

std::string read_text(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError({.file = file}, "cannot be read", "the path of a case file");
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Collects the keys below a table whose arrays have formulas as items.
void collect_vectors(const case_file::Table& table, std::set<std::string>& names,
                     std::set<const case_file::Table*>& seen)
{
  if (!seen.insert(&table).second) return;
  const auto look_at = [&](const std::string& name, const case_file::Value& value, const auto& again) -> void
  {
    if (!value.items.empty() && (value.items.front().is_formula)) names.insert(name);
    if (value.table != nullptr) collect_vectors(*value.table, names, seen);
    for (const case_file::Value& item : value.items) again(name, item, again);
  };
  for (const case_file::Key& key : table.keys) look_at(key.name, key.value, look_at);
  if (table.named) look_at({}, *table.named, look_at);
}

}  // namespace

case_file::Node to_node(const py::handle& value, const std::string& name, const std::string& key)
{
  const Where where{.file = name, .key = key};
  case_file::Node node{{}, where};
  if (py::isinstance<py::dict>(value))
    node.value = to_table(py::reinterpret_borrow<py::dict>(value), name, key);
  else if (py::isinstance<py::str>(value))
    node.value = value.cast<std::string>();
  else if (py::isinstance<py::bool_>(value))
    node.value = value.cast<bool>();
  else if (py::isinstance<py::float_>(value))
    node.value = value.cast<double>();
  else if (py::isinstance<py::array>(value))
    node = to_node(value.attr("tolist")(), name, key);
  else if (PyIndex_Check(value.ptr()) != 0)
    node.value = to_integer(py::module_::import("operator").attr("index")(value), where);
  else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
    node.value = to_items(value, name, key);
  else if (py::hasattr(value, "uses_time"))
    node.value = to_function(value, where);
  else if (py::hasattr(value, "__fspath__"))
    node.value = value.attr("__fspath__")().cast<std::string>();
  else if (py::hasattr(value, "__float__"))
    node.value = value.attr("__float__")().cast<double>();
  else
    throw InputError(
        where,
        fmt::format("is a {}", py::str(py::type::handle_of(value).attr("__name__")).cast<std::string>()),
        "a number, a text, true or false, a list, a dictionary or a function");
  return node;
}

void bind_documents(py::module_& module)
{
  py::class_<Document>(module, "Document")
      .def(py::init(
               [](const py::dict& dictionary, const std::string& name) {
                 return Document{to_node(dictionary, name), name};
               }),
           py::arg("dictionary"), py::arg("name") = "case")
      .def_static(
          "parse",
          [](const std::string& text, const std::string& name) {
            return Document{case_file::parse_toml(text, name), name};
          },
          py::arg("text"), py::arg("name") = "case")
      .def_readonly("name", &Document::name)
      .def("check", [](const Document& document, const std::vector<std::string>& overrides)
           { (void)case_file::make_config(document.node, document.name, overrides); });
  module.def("read_text", &read_text);
  module.def("to_toml",
             [](const py::handle& value) { return case_file::to_inline_toml(to_node(value, "set")); });
  module.def("vector_keys",
             []
             {
               std::set<std::string> names;
               std::set<const case_file::Table*> seen;
               collect_vectors(case_file::case_table(), names, seen);
               return names;
             });
}

}  // namespace tribound::python
