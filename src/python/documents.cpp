// A problem as Python puts it together: the tables of a problem file, from a file, a dict, or one by one.
#include "core/find.hpp"
#include "core/suggest.hpp"
#include "input/document.hpp"
#include "input/key_tree.hpp"
#include "input/settings.hpp"
#include "core/text.hpp"
#include "python/module.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin::python {

namespace {

Node node_of(const py::handle& value, const std::string& key, int depth = 0) {
  constexpr int deepest = 16;
  const auto wrong = [&](const std::string& what) { return InputError({Mistake{{}, 0, 0, key, what}}); };
  const auto text = [&](const py::handle& string) {
    try {
      return string.cast<std::string>();
    } catch (const py::cast_error&) {
      throw wrong("is a string that is no text in UTF-8");
    }
  };
  if (depth > deepest) throw wrong("is nested too deeply; no key is");
  Node node;
  if (py::isinstance<py::bool_>(value)) {
    node.value = value.cast<bool>();
  } else if (py::isinstance<py::str>(value)) {
    node.value = text(value);
  } else if (py::isinstance<py::dict>(value)) {
    Entries entries;
    for (const auto& [k, v] : py::reinterpret_borrow<py::dict>(value)) {
      if (!py::isinstance<py::str>(k)) throw wrong("has a key that is no string");
      const std::string name = text(k);
      if (!v.is_none()) entries.push_back({name, {}, node_of(v, key.empty() ? name : key + "." + name, depth + 1)});
    }
    node.value = std::move(entries);
  } else if (py::isinstance<py::int_>(value)) {
    try {
      node.value = value.cast<std::int64_t>();
    } catch (const py::cast_error&) {
      throw wrong("is an integer that is too large");
    }
  } else if (py::isinstance<py::float_>(value)) {
    node.value = value.cast<double>();
  } else if (py::hasattr(value, "tolist")) {                   // numpy's arrays and numbers
    return node_of(value.attr("tolist")(), key, depth + 1);
  } else if (py::hasattr(value, "__fspath__")) {
    node.value = value.attr("__fspath__")().cast<std::string>();
  } else if (py::isinstance<py::sequence>(value)) {
    List list;
    for (const py::handle element : value) list.push_back(node_of(element, key, depth + 1));
    node.value = std::move(list);
  } else {
    throw wrong("must be a string, a number, a list or a dict, is " + py::repr(py::type::of(value)).cast<std::string>());
  }
  return node;
}

py::object python_of(const Node& node) {
  return std::visit([](const auto& v) -> py::object {
    using T = std::decay_t<decltype(v)>;
    if constexpr (std::is_same_v<T, Date>) return py::none();
    else if constexpr (std::is_same_v<T, List>) {
      py::list list;
      for (const Node& n : v) list.append(python_of(n));
      return list;
    } else if constexpr (std::is_same_v<T, Entries>) {
      py::dict dict;
      for (const Entry& e : v) dict[py::str(e.key)] = python_of(e.node);
      return dict;
    } else return py::cast(v);
  }, node.value);
}

Document document_of(const py::dict& tables, const std::string& name) {
  Document document{name, "", std::get<Entries>(node_of(tables, "").value), {}};
  return document;
}

Entry& entry(Document& document, const std::string& key, const Node& otherwise) {
  for (Entry& e : document.root)
    if (e.key == key) return e;
  return document.root.emplace_back(Entry{key, {}, otherwise});
}

// One more [[key]].
void append(Document& document, const std::string& key, const py::dict& values) {
  Entry& at = entry(document, key, Node{{}, List{}});
  auto* list = std::get_if<List>(&at.node.value);
  if (!list) throw InputError({Mistake{document.file, at.place.line, at.place.column, key, "is there already, and no list of tables"}});
  list->push_back(node_of(values, key));
  document.sha256.clear();
}

// Keys of [key], or with an empty key of what stands before the first table.
void update(Document& document, const std::string& key, const py::dict& values) {
  Entries* entries = &document.root;
  if (!key.empty()) {
    Entry& at = entry(document, key, Node{{}, Entries{}});
    entries = std::get_if<Entries>(&at.node.value);
    if (!entries) throw InputError({Mistake{document.file, at.place.line, at.place.column, key, "is there already, and no table"}});
  }
  const Node node = node_of(values, key);
  for (const Entry& e : std::get<Entries>(node.value)) {
    if (Node* there = find(*entries, e.key)) *there = e.node;
    else entries->push_back(e);
  }
  document.sha256.clear();
}

// All tables of that name go; one that is not there may be missing.
void erase(Document& document, const std::string& key) {
  const std::vector<std::string> known = key_tree().names();
  if (!find(document.root, key) && !contains(known, key))
    throw InputError(fmt::format("clear: {} is no table; allowed: {}{}", in_quotes(key), listed(known), did_you_mean(key, known)));
  std::erase_if(document.root, [&](const Entry& e) { return e.key == key; });
  document.sha256.clear();
}

void set(Document& document, const std::string& key, const py::object& value) {
  Mistakes mistakes(document.file);
  apply({key, to_toml(node_of(value, key))}, document, mistakes);
  mistakes.raise();
  document.sha256.clear();
}

}  // namespace

Document complete(Document document) {
  if (document.sha256.empty()) document.sha256 = sha256(to_toml(document));
  return document;
}

void add_documents(py::module_& module) {
  py::class_<Document>(module, "Document", "The tables of a problem, which know where they stand if they come from a file.")
      .def(py::init(&document_of), py::arg("tables"), py::arg("name"))
      .def_static("read", &read_document, py::arg("file"))
      .def_static("parse", &parse_document, py::arg("text"), py::arg("name"))
      .def("copy", [](const Document& d) { return d; })
      .def("append", &append, py::arg("table"), py::arg("values"))
      .def("update", &update, py::arg("table"), py::arg("values"))
      .def("set", &set, py::arg("key"), py::arg("value"))
      .def("erase", &erase, py::arg("key"))
      .def("has", [](const Document& d, const std::string& key) { return find(d.root, key) != nullptr; }, py::arg("key"))
      .def("tables", [](const Document& d) { return python_of(Node{{}, d.root}); })
      .def("toml", [](const Document& d) { return to_toml(d); })
      .def_readonly("name", &Document::file);
}

}  // namespace elamin::python
