// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/wire/code_names.hpp>
#include <cchip/internal/wire/pair.hpp>

namespace cchip {

std::string to_text(const GridPair& pair) {
  std::string text;
  for (const GridPrimitive* p : {&pair.a, &pair.b}) {
    text += p == &pair.a ? "A" : "  B";
    for (std::size_t i = 0; i < p->vertex_count(); ++i) {
      text += " (" + std::to_string(p->v[i].x()) + ", " + std::to_string(p->v[i].y()) + ", " +
              std::to_string(p->v[i].z()) + ")";
    }
  }
  return text + "  eta " + std::to_string(pair.eta);
}

ModuleId module_of(Kind a, Kind b) {
  return static_cast<ModuleId>(defs::rm_of(static_cast<int>(a), static_cast<int>(b)));
}

const char* to_name(ModuleId id) {
  const char* const name = name_of(id);
  return name == nullptr ? name_of(ModuleId::blank) : name;
}

}  // namespace cchip
