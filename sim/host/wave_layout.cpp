// SPDX-License-Identifier: Apache-2.0
#include <cchip/wave_layout.hpp>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace cchip {

void write_gtkw(const std::string& fst_path) {
  const std::filesystem::path fst(fst_path);
  const std::filesystem::path path = std::filesystem::path(fst).replace_extension(".gtkw");
  std::ofstream out(path);
  out << "[dumpfile] \"" << std::filesystem::absolute(fst).lexically_normal().string() << "\"\n";
  out.close();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written; check folder and permissions");
}

}  // namespace cchip
