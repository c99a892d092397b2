// SPDX-License-Identifier: Apache-2.0
#include "file_content.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace cchip::mesh_io {

std::string read_file(const std::string& path, const std::string& what) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw std::runtime_error(path + ": no such file; check the path");
  if (std::filesystem::is_directory(status)) throw std::runtime_error(path + ": is a folder; name a file in it");
  if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_fifo(status)) {
    throw std::runtime_error(path + ": is a device, not a file or a pipe; name a " + what + " file");
  }
  constexpr std::size_t least_bytes = 65536;
  const auto size = std::filesystem::is_fifo(status) ? 0 : std::filesystem::file_size(path, error);
  std::string content(std::max<std::size_t>(error ? 0 : size + 1, least_bytes), '\0');  // one more, to meet the end
  errno = 0;
  std::ifstream in(std::filesystem::path(path), std::ios::binary);  // on Windows, too, a name is UTF-8 then
  const auto unreadable = [&path] {
    const std::string cause = errno == 0 ? "an error of the disk" : std::strerror(errno);
    return std::runtime_error(path + ": the file cannot be read (" + cause + "); check its permissions");
  };
  if (!in) throw unreadable();
  std::size_t used = 0;
  while (in) {
    if (used == content.size()) content.resize(2 * content.size());
    in.read(&content[used], static_cast<std::streamsize>(content.size() - used));
    used += static_cast<std::size_t>(in.gcount());
  }
  content.resize(used);
  if (in.bad()) throw unreadable();
  if (content.empty()) throw std::runtime_error(path + ": the file is empty (0 bytes); write the " + what + " again");
  return content;
}

std::string name_inside(const std::string& name) {
  const std::filesystem::path path(name);
  std::string end = path.extension().string();
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  return end == ".gz" ? path.stem().string() : name;
}

}  // namespace cchip::mesh_io
