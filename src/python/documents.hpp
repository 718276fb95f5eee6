#pragma once
#include "input/document.hpp"
#include "python/module.hpp"

namespace elamin::python {

/// With the sha256 of its text, where it has been put together or changed.
Document complete(Document document);

}  // namespace elamin::python
