// SPDX-License-Identifier: Apache-2.0
/// \file
/// Assembly, AssemblyReport and AssemblyPair of the Python module.
#ifndef COLLISIONCHIP_PYTHON_ASSEMBLY_HPP
#define COLLISIONCHIP_PYTHON_ASSEMBLY_HPP

#include <nanobind/nanobind.h>

namespace collisionchip_python {

void def_assembly(nanobind::module_& m);

}  // namespace collisionchip_python

#endif
