// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files that get their name only when they are complete.
#ifndef CCHIP_PROGRAM_OUTPUT_FILE_HPP
#define CCHIP_PROGRAM_OUTPUT_FILE_HPP

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <locale>
#include <ostream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace cchip::sim {

/// A file cannot be written. what() is one line: file, cause, remedy.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that is written as part(), `<path>.part`, and renamed by commit(). Until then an older file of that name
/// stays as it is. Without commit() the part is removed. Devices and pipes are written directly, part() is their path.
class PendingFile {
 public:
  /// Creates the part. A symbolic link is followed.
  /// \throws OutputError it cannot be created, or the file that it is to replace may not be written
  explicit PendingFile(std::string path) : path_(std::move(path)), target_(followed(path_)) {
    std::error_code ignored;  // then the file is not there
    const auto status = std::filesystem::status(target_, ignored);
    if (std::filesystem::is_directory(status)) refuse(std::strerror(EISDIR));
    direct_ = std::filesystem::exists(status) && (!std::filesystem::is_regular_file(status) || is_of_system(target_));
    part_ = direct_ ? target_.string() : target_.string() + ".part";
    if (direct_) return;
    replaces_ = std::filesystem::exists(status);
    if (replaces_ && ::access(target_.c_str(), W_OK) != 0) refuse(std::strerror(errno));
    if (!std::ofstream(part_, std::ios::binary)) refuse(std::strerror(errno));
  }
  ~PendingFile() {
    std::error_code ignored;
    if (!direct_ && !committed_) std::filesystem::remove(part_, ignored);
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write.
  const std::string& part() const { return part_; }

  /// Gives the part its name; close it before. \throws OutputError
  void commit() {
    if (direct_ || committed_) return;
    std::error_code error;
    if (replaces_) {
      std::filesystem::permissions(part_, std::filesystem::status(target_).permissions(), error);
    }
    std::filesystem::rename(part_, target_, error);
    if (error) refuse(error.message());
    committed_ = true;
  }

  [[noreturn]] void refuse(const std::string& cause) const {
    throw OutputError(path_ + ": cannot be written (" + cause + "); check folder, permissions and disk space");
  }

 private:
  /// The file behind symbolic links, which need not exist.
  static std::filesystem::path followed(std::filesystem::path path) {
    std::error_code error;
    for (int links = 0; links < 40 && !is_of_system(path) && std::filesystem::is_symlink(path, error); ++links) {
      const std::filesystem::path next = std::filesystem::read_symlink(path, error);
      path = next.is_absolute() ? next : path.parent_path() / next;
    }
    return path;
  }
  /// /dev/stdout and its like: a name of something that is open already, of any kind.
  static bool is_of_system(const std::filesystem::path& path) {
    const std::string whole = std::filesystem::absolute(path).lexically_normal().string();
    const auto is_below = [&whole](const char* folder) { return whole.rfind(folder, 0) == 0; };
    return is_below("/proc/") || (is_below("/dev/") && !is_below("/dev/shm/"));
  }

  std::string path_;
  std::filesystem::path target_;
  std::string part_;
  bool direct_ = false;
  bool replaces_ = false;
  bool committed_ = false;
};

/// The same with a stream, which writes numbers as in the C locale.
class OutputFile {
 public:
  /// \throws OutputError as PendingFile
  explicit OutputFile(const std::string& path) : file_(path), stream_(file_.part(), std::ios::binary) {
    stream_.imbue(std::locale::classic());
    if (!stream_) file_.refuse(std::strerror(errno));
  }
  std::ostream& stream() { return stream_; }
  /// Ends the file and gives it its name. \throws OutputError the file is not complete, or as PendingFile
  void commit() {
    errno = 0;
    stream_.close();
    if (!stream_) file_.refuse(std::strerror(errno == 0 ? EIO : errno));
    file_.commit();
  }

 private:
  PendingFile file_;
  std::ofstream stream_;
};

/// Says now what PendingFile would say; leaves nothing behind.
inline void check_writable(const std::string& path) { const PendingFile file(path); }

/// A path of the command line and the option that names it.
struct NamedPath {
  std::string option;
  std::string path;
};

namespace detail {

/// True if both names lead to one regular file, or would if it existed.
inline bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  const bool a_exists = std::filesystem::exists(a, error);
  const bool b_exists = std::filesystem::exists(b, error);
  if (a_exists != b_exists) return false;
  if (a_exists) return std::filesystem::is_regular_file(a, error) && std::filesystem::equivalent(a, b, error);
  return std::filesystem::weakly_canonical(std::filesystem::absolute(a), error) ==
         std::filesystem::weakly_canonical(std::filesystem::absolute(b), error);
}

}  // namespace detail

/// To be called before anything is read or written. Empty paths stand for options that were not given; an input "-" is
/// standard input.
/// \throws OutputError an output, or its part, is an input or another output
inline void check_outputs(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs) {
  const auto check = [](const NamedPath& output, const NamedPath& other, const char* verb) {
    if (output.path.empty() || other.path.empty()) return;
    if (!detail::same_file(output.path, other.path) && !detail::same_file(output.path + ".part", other.path)) return;
    throw OutputError(output.option + " " + output.path + ": this is the file that " + other.option + " " + verb +
                      "; give another name");
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const NamedPath& input : inputs) {
      if (input.path != "-") check(outputs[i], input, "reads");
    }
    for (std::size_t k = 0; k < i; ++k) check(outputs[i], outputs[k], "writes");
  }
}

}  // namespace cchip::sim

#endif
