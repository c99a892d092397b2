// SPDX-License-Identifier: Apache-2.0
#include "zip_folder.hpp"

#include <zip.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace cchip::assembly {
namespace {

struct Close {
  void operator()(zip_file* file) const { zip_fclose(file); }
};

}  // namespace

void ZipFolder::Discard::operator()(zip* archive) const { zip_discard(archive); }

ZipFolder::ZipFolder(const std::string& path) : path_(path) {
  int code = 0;
  archive_.reset(zip_open(path.c_str(), ZIP_RDONLY, &code));
  if (archive_) return;
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  const std::string what = zip_error_strerror(&error);
  zip_error_fini(&error);
  throw std::runtime_error(path + ": cannot be read as a zip archive: " + what + "; give another file");
}

std::optional<std::string> ZipFolder::read(const std::string& name, Allowance& allowance) const {
  const zip_int64_t number = zip_name_locate(archive_.get(), name.c_str(), ZIP_FL_NOCASE);
  if (number < 0) return std::nullopt;
  const auto refuse = [&](const std::string& what) {
    throw std::runtime_error(path_ + ": " + one_line(name) + ": " + what);
  };
  const std::unique_ptr<zip_file, Close> file(zip_fopen_index(archive_.get(), static_cast<zip_uint64_t>(number), 0));
  if (!file) refuse(std::string("cannot be unpacked: ") + zip_strerror(archive_.get()) + "; save the file anew");
  constexpr std::size_t step = std::size_t{1} << 20;
  std::string content;
  for (;;) {  // what the archive says of the size may be wrong
    const std::size_t before = content.size();
    content.resize(before + step);
    const zip_int64_t got = zip_fread(file.get(), &content[before], step);
    if (got < 0) refuse("its packed data are broken; save the file anew");
    content.resize(before + static_cast<std::size_t>(std::max<zip_int64_t>(got, 0)));
    if (got == 0) return content;
    if (!allowance.spend(static_cast<std::uint64_t>(got), 1)) {
      refuse("unpacks to more than the file may ask for; split the file, or raise most_unpacked_bytes");
    }
  }
}

}  // namespace cchip::assembly
